// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/world.hpp"

namespace edgevox::sim {

enum class CreaseKind { Convex, Concave };

/// A straight stretch of a line where the surface of the world's solids bends by more than
/// kMinBend; world frame, m. Rims of cylinders come as chords.
struct Crease {
  Eigen::Vector3d start;
  Eigen::Vector3d end;
  double solid_angle = 0.0;  ///< rad around the crease that are solid: below pi convex
  CreaseKind kind = CreaseKind::Convex;
  bool rim = false;  ///< a chord of a cylinder's rim
};

/// A point where straight creases of three or more directions that span space meet.
struct Corner {
  Eigen::Vector3d position;  ///< m, world frame
  int creases = 0;           ///< that end at or pass through the point
};

constexpr double kMinBend = 0.1745;  ///< rad

/// All creases of the surface of the union, buried and flush edges left out. Lines are found from
/// the solids' edges and the intersections of their faces, a cylinder's faces only with planes
/// along or across its axis; ends are good to 2 mm. Takes up to seconds for a large world.
std::vector<Crease> findCreases(const World& world);

/// The corners of these creases.
std::vector<Corner> findCorners(const std::vector<Crease>& creases);

/// The parts of the creases seen from at least one viewpoint within `max_range` m, in steps of
/// `step` m.
std::vector<Crease> visibleCreases(const World& world, const std::vector<Crease>& creases,
                                   const std::vector<Eigen::Vector3d>& viewpoints, double max_range,
                                   double step);

}  // namespace edgevox::sim
