// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/world.hpp"

namespace edgevox::sim {

/// A line that may hold creases, cut at `breaks`: between two neighbouring breaks the line is a
/// candidate where `candidate` says so.
struct CreaseLine {
  Eigen::Vector3d origin;       ///< m, the point of the line nearest to the world's origin
  Eigen::Vector3d direction;    ///< unit length
  std::vector<double> breaks;   ///< m along the direction, ascending
  std::vector<bool> candidate;  ///< one fewer than breaks
};

/// A circle that may hold creases.
struct CreaseCircle {
  Eigen::Vector3d centre;  ///< m
  Eigen::Vector3d u;       ///< the circle is centre + cos(a) u + sin(a) v, m
  Eigen::Vector3d v;
};

/// Box edges, face by face intersections of touching solids and lines along cylinders, each line
/// once.
std::vector<CreaseLine> findCreaseLines(const World& world);

/// Rims of cylinders and where planes cut them squarely.
std::vector<CreaseCircle> findCreaseCircles(const World& world);

}  // namespace edgevox::sim
