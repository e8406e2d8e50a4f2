// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/grid/block_grid.hpp"

#include <algorithm>
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

/// Erased blocks take their slots, and buckets, as when they were there.
void BlockTable::insertAgain() {
  const std::vector<VoxelIndex> blocks = std::move(blocks_);
  const std::vector<int32_t> free = std::move(free_);
  *this = BlockTable(seed_);
  for (const VoxelIndex& block : blocks) {
    if (block == kErased) {
      blocks_.push_back(block);
      if (isOverfull()) rehash(2 * buckets_.size());
      continue;
    }
    const size_t known = size();
    if (!inGridRange(block)) throw ArchiveError("a block is out of the grid's range");
    findOrInsert(block);
    if (size() == known) throw ArchiveError("a block is there twice");
  }
  requireFree(free);
  free_ = free;
}

void BlockTable::requireFree(const std::vector<int32_t>& free) const {
  std::vector<int32_t> slots = free;
  std::sort(slots.begin(), slots.end());
  size_t found = 0;
  for (size_t slot = 0; slot < blocks_.size(); ++slot) {
    if (blocks_[slot] != kErased) continue;
    if (found == slots.size() || slots[found++] != static_cast<int32_t>(slot)) {
      throw ArchiveError("the free blocks are not those that were erased");
    }
  }
  if (found != slots.size()) throw ArchiveError("a free block was not erased");
}

}  // namespace edgevox
