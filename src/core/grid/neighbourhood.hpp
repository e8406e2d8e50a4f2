// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "edgevox/grid/block_grid.hpp"

namespace edgevox {

/// The occupancy of one block and kHalo voxels around it, a row of voxels a word.
template <int kEdge, int kHalo>
class Neighbourhood {
 public:
  Neighbourhood(const BitGrid<kEdge>& grid, const VoxelIndex& block) {
    rows_.fill(0);
    for (int z = -1; z <= 1; ++z) {
      for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
          const auto* found = grid.findBlock({block.x + x, block.y + y, block.z + z});
          if (found != nullptr) join(*found, x, y, z);
        }
      }
    }
  }

  const uint64_t* data() const { return rows_.data(); }

 private:
  static constexpr int kSide = kEdge + 2 * kHalo;

  /// Adds the part of the neighbour (x, y, z) that reaches into the rows.
  void join(const typename BitGrid<kEdge>::Block& block, int x, int y, int z) {
    for (int row_z = first(z); row_z < last(z); ++row_z) {
      const int from_z = row_z - kHalo - z * kEdge;
      for (int row_y = first(y); row_y < last(y); ++row_y) {
        const int from_y = row_y - kHalo - y * kEdge;
        const uint64_t bits = block[static_cast<size_t>(from_z * kEdge + from_y)];
        uint64_t& row = rows_[static_cast<size_t>(row_z * kSide + row_y)];
        if (x < 0) row |= bits >> (kEdge - kHalo);
        if (x == 0) row |= bits << kHalo;
        if (x > 0) row |= (bits & ((1U << kHalo) - 1)) << (kHalo + kEdge);
      }
    }
  }

  /// Rows that belong to the neighbour below, at or above the block.
  static int first(int side) { return side < 0 ? 0 : side == 0 ? kHalo : kHalo + kEdge; }
  static int last(int side) { return side < 0 ? kHalo : side == 0 ? kHalo + kEdge : kSide; }

  std::array<uint64_t, static_cast<size_t>(kSide) * kSide> rows_;
};

}  // namespace edgevox
