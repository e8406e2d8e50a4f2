// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/grid/block_grid.hpp"

#include <random>
#include <utility>

namespace edgevox {

uint64_t hashSecret() {
  static const uint64_t secret = [] {
    std::random_device device;
    return uint64_t{device()} << 32 | device();
  }();
  return secret;
}

void BlockTable::insertAgain() {
  const std::vector<VoxelIndex> blocks = std::move(blocks_);
  *this = BlockTable(seed_);
  for (const VoxelIndex& block : blocks) {
    const size_t known = size();
    if (!inGridRange(block)) throw ArchiveError("a block is out of the grid's range");
    findOrInsert(block);
    if (size() == known) throw ArchiveError("a block is there twice");
  }
}

}  // namespace edgevox
