// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "edgevox/grid/block_grid.hpp"

namespace edgevox {

/// The occupancy of one block and kHalo voxels around it, a row of voxels a word.
template <int kSide, int kHalo>
class Neighbourhood {
 public:
  Neighbourhood(const BitGrid<kSide>& grid, const VoxelIndex& block) {
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
  static constexpr int kSpan = kSide + 2 * kHalo;

  /// Adds the part of the neighbour (x, y, z) that reaches into the rows.
  void join(const typename BitGrid<kSide>::Block& block, int x, int y, int z) {
    for (int row_z = first(z); row_z < last(z); ++row_z) {
      const int from_z = row_z - kHalo - z * kSide;
      for (int row_y = first(y); row_y < last(y); ++row_y) {
        const int from_y = row_y - kHalo - y * kSide;
        const uint64_t bits = block[static_cast<size_t>(from_z * kSide + from_y)];
        uint64_t& row = rows_[static_cast<size_t>(row_z * kSpan + row_y)];
        if (x < 0) row |= bits >> (kSide - kHalo);
        if (x == 0) row |= bits << kHalo;
        if (x > 0) row |= (bits & ((1U << kHalo) - 1)) << (kHalo + kSide);
      }
    }
  }

  /// Rows that belong to the neighbour below, at or above the block.
  static int first(int side) { return side < 0 ? 0 : side == 0 ? kHalo : kHalo + kSide; }
  static int last(int side) { return side < 0 ? kHalo : side == 0 ? kHalo + kSide : kSpan; }

  std::array<uint64_t, static_cast<size_t>(kSpan) * kSpan> rows_;
};

}  // namespace edgevox
