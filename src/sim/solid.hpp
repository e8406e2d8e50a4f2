// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <optional>

namespace edgevox::sim {

/// 1 / value, but finite at zero, so that slab tests never multiply zero by infinity.
double safeInverse(double value);

/// Axis-aligned box, m; empty until extended.
struct Aabb {
  Eigen::Vector3d min = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d max = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());

  void extend(const Aabb& other);
  bool overlaps(const Aabb& other) const;
  Aabb inflated(double margin) const;
  double surfaceArea() const;
};

/// Where a ray enters a solid.
struct SurfaceHit {
  double range = 0.0;                                 ///< m along the unit direction
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< outward, unit length
};

enum class Shape { Box, Cylinder };

/// A convex solid: a box, or a cylinder about its own z axis.
struct Solid {
  Shape shape = Shape::Box;
  Eigen::Isometry3d T_world_solid = Eigen::Isometry3d::Identity();  ///< frame at the centre
  Eigen::Vector3d half = Eigen::Vector3d::Ones();  ///< half sizes, m; cylinder: radius twice first
  double reflectivity = 0.5;                       ///< 0 to 1

  Aabb aabb() const;

  /// The first crossing from outside to inside for a ray of unit `direction`; none if it misses
  /// or starts inside. World frame.
  std::optional<SurfaceHit> castRay(const Eigen::Vector3d& origin,
                                    const Eigen::Vector3d& direction) const;

  /// Exact distance to the surface in m, negative inside. World frame.
  double signedDistance(const Eigen::Vector3d& point) const;

  /// True for inside and boundary points. World frame.
  bool contains(const Eigen::Vector3d& point) const;
};

}  // namespace edgevox::sim
