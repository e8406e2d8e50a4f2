// SPDX-License-Identifier: BSD-3-Clause
// Surfaces sampled densely at random orientation and offset, with what is true about them.
// Coordinates in voxels unless said otherwise.
#pragma once

#include <limits>
#include <vector>

#include <Eigen/Core>

#include "edgevox/grid/voxel.hpp"
#include "support/random.hpp"
#include "support/voxel_sets.hpp"

namespace edgevox::test {

struct Segment {
  Eigen::Vector3d from;
  Eigen::Vector3d to;
};

struct Scene {
  std::vector<Eigen::Vector3d> points;
  Voxels voxels;                         ///< those that hold a point
  std::vector<Segment> creases;          ///< where two surfaces meet
  std::vector<Segment> rims;             ///< where a surface just ends
  std::vector<Eigen::Vector3d> corners;  ///< where three surfaces meet

  double creaseDistance(const VoxelIndex& v) const;  ///< of the voxel's centre; infinite: none
  double rimDistance(const VoxelIndex& v) const;
  double cornerDistance(const VoxelIndex& v) const;
};

/// A square of `side`; `sigma` is the noise along the normal.
Scene planeScene(Random& random, double side, double sigma = 0.0);

/// The plane x = 0.5, y and z in [0, side): aligned with the axes.
Scene alignedPlaneScene(int32_t side);

/// Two faces `length` long and `width` wide; `angle` between them [degrees], 180 is flat.
Scene dihedralScene(Random& random, double angle, double length, double width);

/// Three squares at right angles to one another.
Scene cornerScene(Random& random, double side, double sigma = 0.0);

/// A straight line of voxels.
Scene rodScene(Random& random, double length);

/// Circles on a plane, `spacing` apart, as a turning lidar leaves them on the ground.
Scene ringScene(Random& random, double spacing, double radius);

/// The inside of a box of the given size, rotated about its middle, with a smaller box on its
/// floor.
Scene roomScene(Random& random, const Eigen::Vector3d& size, double sigma = 0.0);

/// Each voxel of a cube of side `side` about the origin with the given probability.
Voxels randomCloud(Random& random, int32_t side, double density);

}  // namespace edgevox::test
