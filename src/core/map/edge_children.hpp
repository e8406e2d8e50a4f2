// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "edgevox/grid/block_grid.hpp"
#include "edgevox/grid/voxel.hpp"

namespace edgevox {

/// How many of the 8 voxels in v, which is of level 1, are edge voxels.
inline uint8_t edgeChildrenOf(const BitGrid<16>& edges, const VoxelIndex& v) {
  using Layout = BitGrid<16>::Layout;
  const VoxelIndex corner{2 * v.x, 2 * v.y, 2 * v.z};
  const auto* block = edges.findBlock(Layout::block(corner));
  if (block == nullptr) return 0;
  uint32_t bits = 0;
  for (int i = 0; i < 4; ++i) {  // pairs along x
    const VoxelIndex at{corner.x, corner.y + (i & 1), corner.z + (i >> 1)};
    const uint32_t row = (*block)[static_cast<size_t>(Layout::row(at))];
    bits = bits << 2 | (row >> Layout::column(corner) & 3U);
  }
  return static_cast<uint8_t>(bitCount(bits));
}

}  // namespace edgevox
