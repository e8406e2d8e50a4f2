// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/tracking/motion_model.hpp"

namespace edgevox {
namespace {

constexpr double kTwistGain = 0.5;  // half an interval from the mean velocity to the sweep

}  // namespace

Pose MotionModel::predict(double time, const std::optional<Pose>& since_last, bool moving) const {
  if (!last_) return T_map_sensor_;
  if (since_last) return last_->T_map_sensor * *since_last;
  if (!moving || !twist_) return last_->T_map_sensor;
  return last_->T_map_sensor * extrapolated(*twist_, time - last_->time);
}

Twist MotionModel::predictTwist(const SweepPose& now, bool by_odometry) const {
  return last_ && by_odometry ? twistTo(now) : twist_in_sweep_;
}

Twist MotionModel::twistInSweepAt(const SweepPose& now) const { return twistInSweep(twistTo(now)); }

void MotionModel::add(const SweepPose& now, double stamp) {
  T_map_sensor_ = now.T_map_sensor;
  if (last_) {
    const Twist twist = twistTo(now);
    twist_in_sweep_ = twistInSweep(twist);
    T_map_sensor_ = last_->T_map_sensor * moved(twist, stamp - last_->time);
    twist_ = twist;
  }
  last_ = now;
}

void MotionModel::forget() {
  last_.reset();
  twist_.reset();
  twist_in_sweep_ = {};
}

Twist MotionModel::twistTo(const SweepPose& now) const {
  return twistOf(last_->T_map_sensor.inverse() * now.T_map_sensor, now.time - last_->time);
}

/// The velocity in the middle of the sweep, from the mean ones before it and before that.
Twist MotionModel::twistInSweep(const Twist& twist) const {
  const Twist before = twist_.value_or(Twist{});
  return {twist.linear + kTwistGain * (twist.linear - before.linear),
          twist.angular + kTwistGain * (twist.angular - before.angular)};
}

}  // namespace edgevox
