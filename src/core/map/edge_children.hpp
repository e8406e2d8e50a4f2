// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "edgevox/grid/block_grid.hpp"
#include "edgevox/grid/voxel.hpp"

namespace edgevox {

/// How many of the 8 voxels of the next finer level within v, which is of level 1 to 4, are edge
/// voxels or hold one.
inline uint8_t edgeChildrenOf(const BitGrid<16>& edges, int level, const VoxelIndex& v) {
  const int side = 1 << (level - 1);  // of a finer voxel
  const int32_t scale = 1 << level;
  const VoxelIndex corner{v.x * scale, v.y * scale, v.z * scale};
  const auto* block = edges.findBlock(BitGrid<16>::Layout::block(corner));
  if (block == nullptr) return 0;
  uint8_t count = 0;
  for (int i = 0; i < 4; ++i) {  // pairs of finer voxels
    uint32_t rows = 0;
    const int y = corner.y + (i & 1) * side;
    const int z = corner.z + (i >> 1) * side;
    for (int row = 0; row < side * side; ++row) {
      const VoxelIndex at{corner.x, y + row % side, z + row / side};
      rows |= (*block)[static_cast<size_t>(BitGrid<16>::Layout::row(at))];
    }
    const uint32_t mask = (1U << side) - 1;
    const uint32_t pair = rows >> BitGrid<16>::Layout::column(corner);
    count = static_cast<uint8_t>(count + ((pair & mask) != 0 ? 1 : 0) +
                                 ((pair >> side & mask) != 0 ? 1 : 0));
  }
  return count;
}

}  // namespace edgevox
