// SPDX-License-Identifier: BSD-3-Clause
#include "ros/live/input_monitor.hpp"

#include <cmath>

namespace edgevox {
namespace {

constexpr double kAnotherClock = 3600.0;  // [s]

}  // namespace

void InputMonitor::arrived(const ros::Time& stamp) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++received_;
  last_ = ros::WallTime::now();
  arrivals_.push(last_);
  const double delay = ros::Time::now().toSec() - stamp.toSec();
  delay_ = std::abs(delay) < kAnotherClock ? std::optional<double>(delay) : std::nullopt;
}

InputReading InputMonitor::read() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  InputReading reading;
  reading.received = received_;
  reading.silence = (ros::WallTime::now() - last_).toSec();
  reading.delay = delay_;
  if (arrivals_.size() > 1) {
    const double span = (arrivals_.newest() - arrivals_.oldest()).toSec();
    if (span > 0.0) reading.rate = static_cast<double>(arrivals_.size() - 1) / span;
  }
  return reading;
}

}  // namespace edgevox
