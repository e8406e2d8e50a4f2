// SPDX-License-Identifier: BSD-3-Clause
#include "ros/live/throttled_log.hpp"

#include <ros/console.h>

namespace edgevox {
namespace {

const ros::WallDuration kPause(10.0);

}  // namespace

void ThrottledLog::warn(const std::string& reason, const std::string& text) {
  const std::lock_guard<std::mutex> lock(mutex_);
  Reason& state = reasons_[reason];
  const ros::WallTime now = ros::WallTime::now();
  if (now < state.next) {
    ++state.unsaid;
    return;
  }
  const std::string more =
      state.unsaid == 0 ? "" : " (" + std::to_string(state.unsaid) + " more of this kind before)";
  ROS_WARN_STREAM(node_ << ": " << text << more);
  state = {now + kPause, 0};
}

}  // namespace edgevox
