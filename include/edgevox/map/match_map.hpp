// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "edgevox/grid/block_grid.hpp"
#include "edgevox/grid/voxel.hpp"
#include "edgevox/map/surface_level.hpp"

namespace edgevox {

/// What scans are matched to, a value: a multi-resolution occupied voxel list (Ryde and Hu 2010).
/// Level k has voxels of voxel_size * 2^k. All levels from 1 on hold the bits of all occupied
/// voxels, for the search; levels 1 to kSurfaceLevels hold surfaces, for the refinement; level 0
/// holds the edge voxels of the accumulated occupancy.
class MatchMap {
 public:
  static constexpr int kSurfaceLevels = 2;

  /// An empty map; both sizes in metres, `coarsest_voxel` fixes the number of levels.
  MatchMap(double voxel_size, double coarsest_voxel);

  int levels() const { return static_cast<int>(occupied_.size()); }
  double voxelSize(int level) const { return voxel_size_ * static_cast<double>(1 << level); }

  /// The bits of a level; 1 <= level < levels().
  const BitGrid<8>& occupied(int level) const { return occupied_[static_cast<size_t>(level)]; }
  BitGrid<8>& occupied(int level) { return occupied_[static_cast<size_t>(level)]; }
  /// The surfaces of a level; 1 <= level <= kSurfaceLevels.
  const SurfaceLevel& surfaces(int level) const {
    return surfaces_[static_cast<size_t>(level - 1)];
  }
  SurfaceLevel& surfaces(int level) { return surfaces_[static_cast<size_t>(level - 1)]; }
  const BitGrid<16>& edgeVoxels() const { return edge_voxels_; }
  BitGrid<16>& edgeVoxels() { return edge_voxels_; }

  /// Size of what is held in memory.
  size_t bytes() const;

 private:
  double voxel_size_;
  std::vector<BitGrid<8>> occupied_;  // [0] is not used
  std::vector<SurfaceLevel> surfaces_;
  BitGrid<16> edge_voxels_;
};

}  // namespace edgevox
