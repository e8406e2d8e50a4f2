// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "edgevox/grid/block_grid.hpp"

namespace edgevox {

/// Adds to `out` the voxels of `mask` within `reach` (at most 4) of a voxel of `in`, per axis.
template <int kSide>
class Dilation {
 public:
  using Grid = BitGrid<kSide>;

  Dilation(int reach, const Grid& mask, Grid& out) : reach_(reach), mask_(mask), out_(out) {}

  void add(const Grid& in) {
    for (size_t slot = 0; slot < in.blockCount(); ++slot) {
      spread(in.block(slot));
      const VoxelIndex& at = in.blockIndex(slot);
      for (int z = -1; z <= 1; ++z) {
        for (int y = -1; y <= 1; ++y) {
          for (int x = -1; x <= 1; ++x) emit({at.x + x, at.y + y, at.z + z}, x, y, z);
        }
      }
    }
  }

 private:
  static constexpr int kPad = 4;
  static constexpr int kSpan = kSide + 2 * kPad;
  using Rows = std::array<uint64_t, static_cast<size_t>(kSpan) * kSpan>;

  static size_t at(int y, int z) { return static_cast<size_t>((z + kPad) * kSpan + y + kPad); }

  /// Rows of the block and kPad voxels around it: bit x + kPad.
  void spread(const typename Grid::Block& block) {
    Rows along_y{};
    for (int z = 0; z < kSide; ++z) {
      for (int y = 0; y < kSide; ++y) {
        const auto row = static_cast<uint64_t>(block[static_cast<size_t>(z * kSide + y)]) << kPad;
        if (row == 0) continue;
        uint64_t wide = row;
        for (int d = 1; d <= reach_; ++d) wide |= row << d | row >> d;
        for (int d = -reach_; d <= reach_; ++d) along_y[at(y + d, z)] |= wide;
      }
    }
    rows_.fill(0);
    for (int z = 0; z < kSide; ++z) {
      for (int y = -reach_; y < kSide + reach_; ++y) {
        const uint64_t row = along_y[at(y, z)];
        if (row == 0) continue;
        for (int d = -reach_; d <= reach_; ++d) rows_[at(y, z + d)] |= row;
      }
    }
  }

  /// The part of rows_ that lies in the neighbour (x, y, z) of the block.
  void emit(const VoxelIndex& block, int x, int y, int z) {
    const auto* allowed = mask_.findBlock(block);
    if (allowed == nullptr) return;
    typename Grid::Block* target = nullptr;
    for (int row_z = first(z); row_z < last(z); ++row_z) {
      for (int row_y = first(y); row_y < last(y); ++row_y) {
        const uint64_t row = rows_[at(row_y, row_z)];
        const uint64_t part = x < 0 ? row << (kSide - kPad) : row >> (kPad + x * kSide);
        const auto r = static_cast<size_t>((row_z & (kSide - 1)) * kSide + (row_y & (kSide - 1)));
        const auto bits =
            static_cast<typename Grid::Row>(static_cast<typename Grid::Row>(part) & (*allowed)[r]);
        if (bits == 0) continue;
        if (target == nullptr) target = &out_.editBlock(out_.insertBlock(block));
        (*target)[r] = static_cast<typename Grid::Row>((*target)[r] | bits);
      }
    }
  }

  /// Rows of spread() that lie in the neighbour before, at or behind the block.
  int first(int side) const { return side < 0 ? -reach_ : side == 0 ? 0 : kSide; }
  int last(int side) const { return side < 0 ? 0 : side == 0 ? kSide : kSide + reach_; }

  int reach_;
  const Grid& mask_;
  Grid& out_;
  Rows rows_;
};

}  // namespace edgevox
