// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "edgevox/grid/block_grid.hpp"
#include "edgevox/grid/voxel.hpp"

namespace edgevox {

/// Finds the points of a scan that stand alone: those with fewer than two others in the 3^3
/// neighbourhood of voxels of twice the finest size. A pair may be chance; a surface shows more.
class ScanNeighbours {
 public:
  /// `voxels`: one a point, at the finest size.
  void set(const std::vector<VoxelIndex>& voxels);
  /// Whether a point in `parent`, which is of twice the finest size, has no other near it.
  bool isAlone(const VoxelIndex& parent) const;
  size_t bytes() const { return once_.bytes() + twice_.bytes() + more_.bytes(); }

 private:
  BitGrid<8> once_;   // of twice the size, that hold a point
  BitGrid<8> twice_;  // two or more
  BitGrid<8> more_;   // three or more
};

/// Remembers voxels for some scans: at least half of `scans`, at most all of them.
class RecentVoxels {
 public:
  explicit RecentVoxels(int scans) : half_((scans + 1) / 2) {}

  /// Begins a scan; to be called before each.
  void nextScan();
  /// Whether the voxel is remembered; if not, it is from now on.
  bool findOrInsert(const VoxelIndex& v);
  void clear();
  size_t bytes() const { return recent_.bytes() + older_.bytes(); }

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.age_, self.recent_, self.older_);
  }

 private:
  int half_;  // [scans]
  int age_ = 0;
  BlockTable recent_;
  BlockTable older_;
};

}  // namespace edgevox
