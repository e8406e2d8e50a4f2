// SPDX-License-Identifier: BSD-3-Clause
#include "ros/live/service_offers.hpp"

#include <ros/console.h>
#include <ros/service_manager.h>

namespace edgevox {
namespace {

const ros::WallDuration kPause(0.2);

/// advertiseService() says so as well, but as an error at each attempt.
bool isTaken(const std::string& name) {
  return ros::ServiceManager::instance()->lookupServicePublication(name) != nullptr;
}

}  // namespace

void ServiceOffers::start() {
  offerAll();
  const std::string text = missing();
  const std::lock_guard<std::mutex> lock(mutex_);
  if (text.empty() || withdrawn_) return;
  ROS_WARN_STREAM("services " << text);
  timer_ = handle_.createWallTimer(kPause, [this](const ros::WallTimerEvent&) { offerAll(); });
}

void ServiceOffers::offerAll() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (withdrawn_) return;
  for (Offer& offer : offers_) {
    if (!offer.server && !isTaken(offer.name)) offer.server = offer.advertise();
  }
}

void ServiceOffers::withdraw() {
  const std::lock_guard<std::mutex> lock(mutex_);
  withdrawn_ = true;
  for (Offer& offer : offers_) offer.server.shutdown();
}

std::string ServiceOffers::missing() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::string names;
  for (const Offer& offer : offers_) {
    if (!offer.server) names += (names.empty() ? "" : ", ") + offer.name;
  }
  if (names.empty()) return "";
  return "not offered yet, as another nodelet of this process still does: " + names +
         "; wait until the one that was unloaded has ended its work, or give each mapper a "
         "namespace of its own";
}

}  // namespace edgevox
