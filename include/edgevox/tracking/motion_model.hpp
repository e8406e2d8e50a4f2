// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "edgevox/grid/voxel.hpp"
#include "edgevox/scan/motion.hpp"

namespace edgevox {

/// The sensor in the middle of a sweep.
struct SweepPose {
  double time = 0.0;  ///< [s]
  Pose T_map_sensor = Pose::Identity();

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.time, self.T_map_sensor);
  }
};

/// Where the sensor will be, by an odometry or at constant velocity, and how it moves in a sweep.
class MotionModel {
 public:
  /// Whether a sweep has been added since the motion was forgotten.
  bool known() const { return last_.has_value(); }
  /// The last sweep; requires known().
  const SweepPose& last() const { return *last_; }
  /// The pose at the stamp of the last sweep, also when the motion is not known any more.
  const Pose& T_map_sensor() const { return T_map_sensor_; }
  /// The mean from the last but one sweep to the last; none before the second.
  const std::optional<Twist>& velocity() const { return twist_; }
  /// The motion in the last sweep.
  const Twist& twistInSweep() const { return twist_in_sweep_; }

  /// T_map_sensor in the middle of the sweep at `time` [s], by the motion since the last one if an
  /// odometry knows it; else `moving` as before or standing.
  Pose predict(double time, const std::optional<Pose>& since_last, bool moving) const;
  /// The motion in the sweep at `now.time`, for its deskewing, if it is predicted at
  /// `now.T_map_sensor`.
  Twist predictTwist(const SweepPose& now, bool by_odometry) const;
  /// The motion in the sweep if it is at `now.T_map_sensor`; requires known().
  Twist twistInSweepAt(const SweepPose& now) const;

  /// Adds a located sweep of a scan with this stamp [s].
  void add(const SweepPose& now, double stamp);
  /// The next sweep is the first; the pose stays.
  void forget();
  /// The next sweep is the first, at this pose.
  void set(const Pose& T_map_sensor) {
    forget();
    T_map_sensor_ = T_map_sensor;
  }

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.T_map_sensor_, self.last_, self.twist_, self.twist_in_sweep_);
  }

 private:
  Twist twistTo(const SweepPose& now) const;
  Twist twistInSweep(const Twist& twist) const;

  Pose T_map_sensor_ = Pose::Identity();
  std::optional<SweepPose> last_;
  std::optional<Twist> twist_;  // from the last but one sweep to the last
  Twist twist_in_sweep_;        // in the last one
};

}  // namespace edgevox
