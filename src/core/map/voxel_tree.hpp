// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include "core/compression.hpp"
#include "edgevox/grid/block_grid.hpp"
#include "edgevox/grid/voxel.hpp"

namespace edgevox {

/// Orders voxels as an octree does: those of a coarser voxel follow one another, at every level.
bool isBeforeInTree(const VoxelIndex& a, const VoxelIndex& b);

template <int kSide>
std::vector<VoxelIndex> inTreeOrder(const BitGrid<kSide>& grid) {
  std::vector<VoxelIndex> voxels;
  grid.forEach([&](const VoxelIndex& v) { voxels.push_back(v); });
  std::sort(voxels.begin(), voxels.end(), isBeforeInTree);
  return voxels;
}

/// Of the hit voxels those that are no edges but share a voxel of level 1 with one, in the order of
/// the tree.
std::vector<VoxelIndex> besideEdges(const BitGrid<16>& hit, const BitGrid<16>& edges);

/// A set of voxels as an octree of six levels: of each voxel that holds some, from 32 times coarser
/// on, which of its eight children do. Compresses well since surfaces look alike.
struct VoxelTree {
  std::vector<VoxelIndex> roots;      ///< 32 times coarser, in the order of the tree
  std::vector<PackedBytes> children;  ///< a byte a voxel, level by level, the coarsest first

  VoxelTree() = default;
  /// `voxels`: in the order of the tree, none twice.
  explicit VoxelTree(const std::vector<VoxelIndex>& voxels);
  /// In the order of the tree. Throws ArchiveError if they are no octree, or out of range.
  std::vector<VoxelIndex> voxels() const;

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.roots, self.children);
  }
};

}  // namespace edgevox
