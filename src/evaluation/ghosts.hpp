// SPDX-License-Identifier: BSD-3-Clause
// What the map holds of things that are no longer there.
#pragma once

#include <cstddef>
#include <vector>

#include "edgevox/grid/voxel.hpp"
#include "evaluation/recording.hpp"
#include "sim/world.hpp"

namespace edgevox {

/// Tells ghosts in the map of a simulated recording.
class GhostJudge {
 public:
  /// Judges a map of the scans from `begin` to `end` [s]. `truth` must outlive this.
  GhostJudge(const SimulatedTruth& truth, double begin, double end);

  /// Whether the centroid of an occupied voxel is within one voxel of where something was meanwhile
  /// and more than 1.5 voxels from all that stands there in the end. World frame [m].
  bool isGhost(const Eigen::Vector3d& centroid, double voxel_size) const;

  /// The number of ghosts among centroids in a grid's frame [m].
  size_t count(const std::vector<Eigen::Vector3f>& centroids, double voxel_size,
               const Pose& T_world_grid) const;

 private:
  const sim::World& still_;
  sim::World moved_;  // where something was
  sim::World left_;   // what of it is there in the end
};

}  // namespace edgevox
