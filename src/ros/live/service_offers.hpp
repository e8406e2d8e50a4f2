// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace edgevox {

/// Services that are offered as soon as their names are free. A process cannot offer a name twice,
/// and a nodelet that is unloaded while one of its callbacks runs lives, and keeps its names, until
/// that has ended. Safe to use from several threads.
class ServiceOffers {
 public:
  explicit ServiceOffers(const ros::NodeHandle& handle) : handle_(handle) {}

  /// `owner` must outlive this.
  template <typename Owner, typename Request, typename Response>
  void add(const std::string& name, bool (Owner::*callback)(Request&, Response&), Owner* owner) {
    const std::lock_guard<std::mutex> lock(mutex_);
    offers_.push_back({handle_.resolveName(name),
                       [=] { return handle_.advertiseService(name, callback, owner); },
                       {}});
  }
  /// Offers what was added, now or as soon as it can.
  void start();
  /// Offers nothing any more; waits for callbacks that run.
  void withdraw();

  /// What keeps services from being offered and what to do, in words; empty if nothing does.
  std::string missing() const;

 private:
  struct Offer {
    std::string name;  // resolved
    std::function<ros::ServiceServer()> advertise;
    ros::ServiceServer server;  // valid once it is offered
  };

  void offerAll();

  ros::NodeHandle handle_;
  mutable std::mutex mutex_;  // of the offers
  std::vector<Offer> offers_;
  bool withdrawn_ = false;
  ros::WallTimer timer_;
};

}  // namespace edgevox
