// SPDX-License-Identifier: BSD-3-Clause
// Scans of a scene, and what they leave in voxels, recomputed from all centroids at once.
#pragma once

#include <map>
#include <vector>

#include <Eigen/Core>

#include "support/scenes.hpp"

namespace edgevox::test {

constexpr double kScanMapVoxel = 0.1;  ///< of the maps that the scans are meant for [m]

/// Of one scan, in the map frame [m].
using Centroids = std::vector<Eigen::Vector3d>;

/// Scans of a room [voxels] with noise of a fifth of a voxel, each of a part of it and of a third
/// of what lies there.
std::vector<Centroids> randomScans(uint32_t seed, int count,
                                   const Eigen::Vector3d& room = {50, 40, 25});

/// A sensor so far off that no surface of the scans is seen from behind [m].
inline Eigen::Vector3d farSensor() { return {600, 500, 800}; }

/// What all scans together left in a voxel.
struct AccumulatedCell {
  Centroids centroids;
  int hits = 0;  ///< scans
  int last_scan = -1;
};
using AccumulatedCells = std::map<VoxelIndex, AccumulatedCell>;

/// Voxels of kScanMapVoxel * 2^level.
AccumulatedCells accumulate(const std::vector<Centroids>& scans, int level);

Voxels withHits(const AccumulatedCells& cells, int min_hits);

}  // namespace edgevox::test
