// SPDX-License-Identifier: BSD-3-Clause
#include "ros/live/transform_input.hpp"

#include <ros/console.h>

#include <utility>

namespace edgevox {
namespace {

constexpr uint32_t kQueue = 100;  // messages
const ros::WallDuration kPoll(0.01);

}  // namespace

TransformInput::TransformInput(const ros::NodeHandle& handle, const ros::Duration& cache,
                               double leap, ThrottledLog& log)
    : log_(log),
      transforms_(cache, leap),
      tf_(subscribe(handle, "/tf", false)),
      tf_static_(subscribe(handle, "/tf_static", true)),
      thread_([this] { listen(); }) {}

TransformInput::~TransformInput() {
  stopping_ = true;
  thread_.join();
}

ros::Subscriber TransformInput::subscribe(ros::NodeHandle handle, const std::string& topic,
                                          bool is_static) {
  ros::SubscribeOptions options;
  options.initByFullCallbackType<const Event&>(
      topic, kQueue, [this, is_static](const Event& event) { receive(event, is_static); });
  options.callback_queue = &queue_;
  return handle.subscribe(options);
}

void TransformInput::listen() {
  while (!stopping_) {
    try {
      queue_.callAvailable(kPoll);
    } catch (const std::exception& error) {
      note({"exception", std::string("a message on TF was given up: ") + error.what()});
    }
  }
}

void TransformInput::receive(const Event& event, bool is_static) {
  watchClock();
  const std::string authority = event.getPublisherName();
  for (const auto& transform : event.getConstMessage()->transforms) {
    if (const auto refusal = transforms_.add(transform, authority, is_static)) note(*refusal);
  }
}

/// tf2 would refuse the transforms of the new time, as too old.
void TransformInput::watchClock() {
  const ros::Time now = ros::Time::now();
  const ros::Time before = std::exchange(last_, now);
  if (!(now < before)) return;
  ROS_WARN_STREAM("the clock has jumped back by " << before.toSec() - now.toSec()
                                                  << " s: the transforms are forgotten");
  transforms_.clear();
}

void TransformInput::note(const TransformRefusal& refusal) {
  log_.warn("transform_" + refusal.reason, refusal.text);
  const std::lock_guard<std::mutex> lock(mutex_);
  ++reading_.refused;
  reading_.last_refusal = refusal.text;
}

TransformReading TransformInput::reading() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return reading_;
}

}  // namespace edgevox
