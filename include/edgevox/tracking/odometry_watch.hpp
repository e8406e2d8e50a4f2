// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "edgevox/grid/voxel.hpp"
#include "edgevox/scan/motion.hpp"

namespace edgevox {

/// Follows an odometry from scan to scan, located or not. A step that the sensor cannot have made,
/// as after a reset of a filter, is replaced by one at constant velocity; the steps after it count
/// again. Only differences of poses are used.
class OdometryWatch {
 public:
  /// `max_speed` [m/s], `max_turn` [rad/s]: of the sensor.
  OdometryWatch(double max_speed, double max_turn) : max_speed_(max_speed), max_turn_(max_turn) {}

  /// The pose at the stamp [s] of the next scan. False if it is not finite, or too far from the one
  /// before.
  bool add(double stamp, const std::optional<Pose>& T_odom_sensor);
  /// The motion from the last located scan to the one added last; none: not known.
  std::optional<Pose> sinceLocated() const { return has_pose_ ? since_located_ : std::nullopt; }

  /// The scan added last is located; `velocity`: by the located scans, if it is known.
  void located(const std::optional<Twist>& velocity);
  /// The next scan is the first.
  void forget() { *this = OdometryWatch(max_speed_, max_turn_); }

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.last_, self.has_pose_, self.since_located_, self.velocity_, self.last_step_);
  }

 private:
  struct StampedPose {
    double stamp = 0.0;  // [s]
    Pose T_odom_sensor = Pose::Identity();

    template <typename Self, typename Archive>
    static void archive(Self& self, Archive& bytes) {
      bytes(self.stamp, self.T_odom_sensor);
    }
  };

  bool isInLimits(const Pose& step, double seconds) const;
  bool hasInertia(const Pose& step, double seconds) const;
  Pose usualStep(double seconds) const;

  double max_speed_;
  double max_turn_;
  std::optional<StampedPose> last_;    // that was finite
  bool has_pose_ = false;              // whether it is of the scan added last
  std::optional<Pose> since_located_;  // up to it
  std::optional<Twist> velocity_;      // by the located scans or, since then, as below
  std::optional<Twist> last_step_;     // within the limits
};

}  // namespace edgevox
