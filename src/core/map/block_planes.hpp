// SPDX-License-Identifier: BSD-3-Clause
// Planes that many voxels of a map lie in.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "edgevox/grid/voxel.hpp"
#include "edgevox/map/match_map.hpp"
#include "edgevox/map/plane_level.hpp"
#include "edgevox/map/surface.hpp"

namespace edgevox {

/// What was seen of a voxel of level 1 from one side of its surface.
struct VoxelSide {
  VoxelIndex voxel;
  Moments moments;       ///< about the centre of its block
  Eigen::Vector3d view;  ///< sum of the unit vectors to the sensor
};

/// The planes in one block of 8 voxels of level 1 a side: at each place those of the coarsest
/// voxels in which all is as flat as in finer ones.
class BlockPlanes {
 public:
  static constexpr int kFinest = MatchMap::kFinestPlanes;
  static constexpr int kCoarsest =
      MatchMap::kCoarsestPlanes;  ///< whose voxels are as large as a block

  /// `size` [m] is that of voxels of level 1. Planes of `before` stay where points are forgotten
  /// that they were fitted to, until as many others lie as wide.
  BlockPlanes(const VoxelIndex& block, const std::vector<VoxelSide>& sides, double size,
              const MatchMap& before);

  /// Calls visit(level, VoxelIndex, VoxelPlanes) for all voxels of the levels in the block, also
  /// for those without planes.
  template <typename Visit>
  void forEachVoxel(Visit&& visit) const {
    for (int level = kFinest; level <= kCoarsest; ++level) {
      for (size_t i = 0; i < planesOf(level).size(); ++i) {
        visit(level, voxelAt(level, i), planesOf(level)[i]);
      }
    }
  }

  /// Whether its points lie in a plane of the block.
  bool explains(const VoxelSide& side) const;

 private:
  static constexpr size_t kLevels = kCoarsest - kFinest + 1;

  static size_t index(int level) { return static_cast<size_t>(level - kFinest); }
  std::vector<VoxelPlanes>& planesOf(int level) { return planes_[index(level)]; }
  const std::vector<VoxelPlanes>& planesOf(int level) const { return planes_[index(level)]; }
  static int sideOf(int level) { return 1 << (kCoarsest - level); }  // of a block [voxel]
  VoxelIndex voxelAt(int level, size_t i) const;
  size_t positionOf(int level, const VoxelIndex& v) const;
  /// From the block's centre to that of a voxel [m].
  Eigen::Vector3d centreOf(int level, size_t i) const;
  void fit(int level, const std::vector<VoxelSide>& sides, const PlaneLevel& before);
  void dropCovered(int level);
  bool isCovered(int level, size_t i, const Plane& plane, float needed);

  VoxelIndex block_;
  double size_;
  std::array<std::vector<VoxelPlanes>, kLevels> planes_;
  // the most information of the planes that a plane stands for, by side
  std::array<std::vector<std::array<float, 2>>, kLevels> needed_;
};

}  // namespace edgevox
