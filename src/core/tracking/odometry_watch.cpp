// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/tracking/odometry_watch.hpp"

#include <cmath>
#include <utility>

namespace edgevox {
namespace {

constexpr double kLeastTranslation = 0.5;              // that is told from noise [m]
constexpr double kLeastRotation = 5.0 * M_PI / 180.0;  // the same [rad]
constexpr double kMaxAcceleration = 20.0;              // [m/s^2]
constexpr double kStandsStill = 1e-6;                  // at most [m]
constexpr double kLeastInterval = 1e-3;                // that gives a velocity [s]

/// from^-1 * to; far from the origin as exact as the poses are.
Pose stepBetween(const Pose& from, const Pose& to) {
  Pose step = Pose::Identity();
  step.linear() = from.linear().transpose() * to.linear();
  step.translation() = from.linear().transpose() * (to.translation() - from.translation());
  return step;
}

}  // namespace

bool OdometryWatch::add(double stamp, const std::optional<Pose>& T_odom_sensor) {
  has_pose_ = T_odom_sensor && T_odom_sensor->matrix().allFinite();
  if (!has_pose_) return !T_odom_sensor;
  const auto before = std::exchange(last_, StampedPose{stamp, *T_odom_sensor});
  if (!before) return true;
  const double seconds = stamp - before->stamp;
  const Pose step = stepBetween(before->T_odom_sensor, *T_odom_sensor);
  const bool in_limits = isInLimits(step, seconds);
  const bool possible = in_limits && hasInertia(step, seconds);
  if (since_located_) *since_located_ = *since_located_ * (possible ? step : usualStep(seconds));
  if (in_limits && std::abs(seconds) >= kLeastInterval) {
    last_step_ = twistOf(step, seconds);
    if (possible) velocity_ = last_step_;
  }
  return possible;
}

void OdometryWatch::located(const std::optional<Twist>& velocity) {
  since_located_.reset();
  if (has_pose_) since_located_ = Pose::Identity();
  if (velocity) velocity_ = velocity;
}

/// False, too, if the step is not finite.
bool OdometryWatch::isInLimits(const Pose& step, double seconds) const {
  const double time = std::abs(seconds);
  if (!(step.translation().norm() <= kLeastTranslation + max_speed_ * time)) return false;
  return rotationAngle(step) <= kLeastRotation + max_turn_ * time;
}

/// Compares with the velocity by the map and, as that may be wrong, with the odometry itself; but
/// one that stands still, perhaps broken, is no witness of its own.
bool OdometryWatch::hasInertia(const Pose& step, double seconds) const {
  const auto continues = [&](const std::optional<Twist>& velocity) {
    const double off = (step.translation() - velocity->linear * seconds).norm();
    return off <= kLeastTranslation + kMaxAcceleration * seconds * seconds;
  };
  if (!velocity_ || continues(velocity_)) return true;
  return last_step_ && step.translation().norm() > kStandsStill && continues(last_step_);
}

Pose OdometryWatch::usualStep(double seconds) const {
  return velocity_ ? extrapolated(*velocity_, seconds) : Pose::Identity();
}

}  // namespace edgevox
