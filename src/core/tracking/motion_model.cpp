// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/tracking/motion_model.hpp"

#include <algorithm>

namespace edgevox {
namespace {

constexpr double kLongestExtrapolation = 2.0;  // of the motion [s]
constexpr double kTwistGain = 0.5;  // half an interval from the mean velocity to the sweep

}  // namespace

Pose MotionModel::predict(const SweepPose& now, bool moving) const {
  if (!last_) return T_map_sensor_;
  if (now.T_odom_sensor && last_->T_odom_sensor) {
    return last_->T_map_sensor * last_->T_odom_sensor->inverse() * *now.T_odom_sensor;
  }
  if (!moving) return last_->T_map_sensor;
  const double seconds = std::min(now.time - last_->time, kLongestExtrapolation);
  return last_->T_map_sensor * moved(twist_, seconds);
}

Twist MotionModel::predictTwist(const SweepPose& now, const Pose& guess) const {
  const bool has_odom = last_ && now.T_odom_sensor && last_->T_odom_sensor;
  return has_odom ? twistTo(now, guess) : twist_in_sweep_;
}

Twist MotionModel::twistInSweepAt(const SweepPose& now) const {
  return twistInSweep(twistTo(now, now.T_map_sensor));
}

void MotionModel::add(const SweepPose& now, double stamp) {
  T_map_sensor_ = now.T_map_sensor;
  if (last_) {
    const Twist twist = twistTo(now, now.T_map_sensor);
    twist_in_sweep_ = twistInSweep(twist);
    T_map_sensor_ = last_->T_map_sensor * moved(twist, stamp - last_->time);
    twist_ = twist;
  }
  last_ = now;
}

void MotionModel::forget() {
  last_.reset();
  twist_ = {};
  twist_in_sweep_ = {};
}

Twist MotionModel::twistTo(const SweepPose& now, const Pose& T_map_sensor) const {
  return twistOf(last_->T_map_sensor.inverse() * T_map_sensor, now.time - last_->time);
}

/// The velocity in the middle of the sweep, from the mean ones before it and before that.
Twist MotionModel::twistInSweep(const Twist& twist) const {
  return {twist.linear + kTwistGain * (twist.linear - twist_.linear),
          twist.angular + kTwistGain * (twist.angular - twist_.angular)};
}

}  // namespace edgevox
