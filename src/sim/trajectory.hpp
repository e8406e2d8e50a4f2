// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace edgevox::sim {

/// A corner of the sensor's path, m in the world frame. `speed` (m/s) holds for the leg that ends
/// here; 0 takes the gait's.
struct Waypoint {
  Eigen::Vector3d position;
  double speed = 0.0;
};

/// How the sensor is carried along the path.
struct Gait {
  double speed = 1.2;            ///< m/s
  double smoothing = 0.5;        ///< s between spline controls; larger cuts corners wider
  double stand_still = 1.0;      ///< s without motion at the start and at the end
  double sway_position = 0.015;  ///< m, amplitude at full speed
  double sway_angle = 0.025;     ///< rad, amplitude at full speed
  double sway_frequency = 0.9;   ///< Hz
};

/// The true motion of the sensor: x forward, y left, z up.
class Trajectory {
 public:
  /// A walk along the waypoints: a uniform cubic B-spline of position and heading, so velocity
  /// and acceleration are continuous. Throws std::invalid_argument for fewer than two waypoints
  /// or a speed or smoothing that is not positive.
  Trajectory(const std::vector<Waypoint>& waypoints, const Gait& gait);

  /// `count` level standing positions spread evenly over this walk, `period` s each.
  Trajectory stations(int count, double period) const;

  /// T_world_sensor at `time` s from the start; held beyond either end.
  Eigen::Isometry3d poseAt(double time) const;

  /// s from the first to the last pose.
  double duration() const;

 private:
  using Control = Eigen::Vector4d;  // position in m, heading in rad without jumps

  struct Sample {
    Control value;
    Control rate;  // per s
  };

  Trajectory() = default;
  Sample interpolate(double time) const;

  std::vector<Control> controls_;
  Gait gait_;
  double step_ = 1.0;      // s between controls
  bool standing_ = false;  // each control holds for one step
};

}  // namespace edgevox::sim
