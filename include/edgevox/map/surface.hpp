// SPDX-License-Identifier: BSD-3-Clause
// From the points in a voxel to the surface in it.
#pragma once

#include <array>

#include <Eigen/Core>

#include "edgevox/grid/voxel.hpp"
#include "edgevox/map/surface_level.hpp"

namespace edgevox {

/// Sums over points about some origin.
struct Moments {
  double count = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();    ///< [m]
  Eigen::Matrix3d outer = Eigen::Matrix3d::Zero();  ///< [m^2]

  /// The sums over `count` points at one place.
  static Moments at(const Eigen::Vector3d& point, double count);
  Moments& operator+=(const Moments& more);
  /// The sums over the same points about another origin.
  Moments about(const Eigen::Vector3d& origin) const;
};

/// The matrix of xx, yy, zz, xy, yz, zx.
Eigen::Matrix3d symmetric(const std::array<float, 6>& elements);

/// The shape of the points in a voxel.
struct SurfaceShape {
  Eigen::Matrix3d covariance;  ///< of the points, with what few of them leave open [m^2]
  double greatest;             ///< eigenvalue [m^2]
  Eigen::Matrix3d across;      ///< information across the surface [1/m^2]; zero if there is none
  Eigen::Index axis = 0;       ///< nearest to the normal
  Eigen::Vector3d normal;
  double thickness;  ///< variance along the normal, of all
  double patch;      ///< 1 for a patch of surface, 0 for a line, as one ring of a lidar draws it:
                     ///< the normal of a line is any
  bool flat;

  /// Of points in a voxel of `size` [m]; there must be some.
  SurfaceShape(const Moments& moments, double size);
  /// Whether it is flat and wide enough to fix a position along its normal.
  bool isPatch() const;
};

/// The surface of points; `moments` about the centre of their voxel of `size` [m]. `view`: sum of
/// the unit vectors to the sensor.
Surface surfaceOf(const Moments& moments, const VoxelIndex& v, double size,
                  const Eigen::Vector3d& view);

/// See Surface::side: of a flat surface, by its unit normal, which points to where it was seen
/// from; of any other, by the unit vector to where it was seen from.
Eigen::Vector3f sideOfFlat(const Eigen::Vector3d& normal);
Eigen::Vector3f sideOfRough(const Eigen::Vector3d& view);

/// The surface through the centroids of finer voxels, which is all that a compact map keeps of
/// edges; `moments` as of addCentroid(). It has no sides.
Surface surfaceOfCentroids(const Moments& moments, const VoxelIndex& v, double size);
/// Adds the centroid of a finer voxel about the centre of the coarser one [m].
void addCentroid(const Eigen::Vector3d& centroid, Moments& moments);

}  // namespace edgevox
