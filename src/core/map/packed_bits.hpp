// SPDX-License-Identifier: BSD-3-Clause
// Blocks of bits of surfaces in a quarter of their size.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "edgevox/grid/block_grid.hpp"

namespace edgevox {

/// A block as 64 cells of 4 voxels a side: a word that tells which of them hold a bit, then the
/// words of those.
inline void appendBits(const BitGrid<16>::Block& block, std::vector<uint64_t>& words) {
  std::array<uint64_t, 64> cells{};
  for (size_t row = 0; row < block.size(); ++row) {
    const size_t y = row & 15;
    const size_t z = row >> 4;
    for (size_t x = 0; x < 4; ++x) {
      const uint64_t four = block[row] >> (4 * x) & 15U;
      cells[z / 4 * 16 + y / 4 * 4 + x] |= four << (16 * (z % 4) + 4 * (y % 4));
    }
  }
  uint64_t held = 0;
  for (size_t i = 0; i < cells.size(); ++i) held |= uint64_t{cells[i] != 0} << i;
  words.push_back(held);
  for (const uint64_t cell : cells) {
    if (cell != 0) words.push_back(cell);
  }
}

/// Sets an empty block to what appendBits() has put at `words`; gives what is behind it.
inline const uint64_t* readBits(const uint64_t* words, BitGrid<16>::Block& block) {
  const uint64_t held = *words++;
  for (size_t i = 0; i < 64; ++i) {
    if ((held >> i & 1) == 0) continue;
    const uint64_t cell = *words++;
    for (size_t r = 0; r < 16; ++r) {
      uint16_t& row = block[(i / 16 * 4 + r / 4) * 16 + i / 4 % 4 * 4 + r % 4];
      row = static_cast<uint16_t>(row | (cell >> (4 * r) & 15U) << (i % 4 * 4));
    }
  }
  return words;
}

}  // namespace edgevox
