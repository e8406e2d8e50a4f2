// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "sim/parts.hpp"
#include "sim/world.hpp"

namespace edgevox::sim {

/// Something that walks to and fro along a line, or stands on its only point, and is there for a
/// while. Times are in s from the trajectory's start.
struct Mover {
  Solids parts;                       ///< in its own frame: x ahead, z up, origin on the ground
  std::vector<Eigen::Vector3d> line;  ///< at least one point, m, world frame
  double speed = 0.0;                 ///< m/s
  double lead = 0.0;                  ///< m along the line at time 0
  double begin = -std::numeric_limits<double>::infinity();
  double end = std::numeric_limits<double>::infinity();  ///< no longer there at this time

  bool isThere(double time) const { return time >= begin && time < end; }
  Eigen::Isometry3d poseAt(double time) const;  ///< T_world_mover
};

using Movers = std::vector<Mover>;

/// What is there at `time`, world frame.
Solids solidsAt(const Movers& movers, double time);

/// What has been occupied at some time from `from` to `to`, taken in steps of 0.1 s.
World volumeOf(const Movers& movers, double from, double to);

}  // namespace edgevox::sim
