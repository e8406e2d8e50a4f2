// SPDX-License-Identifier: BSD-3-Clause
// Semi-sparse voxel grids (Ryde et al. 2013, III-C): blocks found by hash, dense bits inside.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <type_traits>
#include <vector>

#include "edgevox/voxel.hpp"

namespace edgevox {

/// Open-addressing hash from a block's index to its slot; slots are 0, 1, 2, ... in order of
/// insertion, so that the order of iteration depends on the input alone.
class BlockTable {
 public:
  static constexpr int32_t kNone = -1;

  BlockTable() : buckets_(kMinBuckets, kNone) {}

  int32_t find(const VoxelIndex& block) const {
    for (size_t b = firstBucket(block);; b = (b + 1) & (buckets_.size() - 1)) {
      const int32_t slot = buckets_[b];
      if (slot == kNone || blocks_[static_cast<size_t>(slot)] == block) return slot;
    }
  }

  int32_t findOrInsert(const VoxelIndex& block) {
    size_t b = firstBucket(block);
    for (; buckets_[b] != kNone; b = (b + 1) & (buckets_.size() - 1)) {
      if (blocks_[static_cast<size_t>(buckets_[b])] == block) return buckets_[b];
    }
    const auto slot = static_cast<int32_t>(blocks_.size());
    buckets_[b] = slot;
    blocks_.push_back(block);
    if (2 * blocks_.size() > buckets_.size()) rehash(2 * buckets_.size());
    return slot;
  }

  size_t size() const { return blocks_.size(); }
  const VoxelIndex& block(size_t slot) const { return blocks_[slot]; }

  void clear() {
    blocks_.clear();
    buckets_.assign(buckets_.size(), kNone);
  }

  size_t bytes() const {
    return buckets_.capacity() * sizeof(int32_t) + blocks_.capacity() * sizeof(VoxelIndex);
  }

 private:
  static constexpr size_t kMinBuckets = 64;

  size_t firstBucket(const VoxelIndex& block) const {
    return voxelHash(block) & (buckets_.size() - 1);
  }

  void rehash(size_t bucket_count) {
    buckets_.assign(bucket_count, kNone);
    for (size_t slot = 0; slot < blocks_.size(); ++slot) {
      size_t b = firstBucket(blocks_[slot]);
      while (buckets_[b] != kNone) b = (b + 1) & (buckets_.size() - 1);
      buckets_[b] = static_cast<int32_t>(slot);
    }
  }

  std::vector<int32_t> buckets_;  // a power of two, at most half full
  std::vector<VoxelIndex> blocks_;
};

/// The place of a voxel inside a block of kEdge voxels a side.
template <int kEdge>
struct BlockLayout {
  static_assert(kEdge == 8 || kEdge == 16 || kEdge == 32, "a row of voxels is one word");
  static constexpr int kShift = kEdge == 8 ? 3 : kEdge == 16 ? 4 : 5;
  static constexpr int kRows = kEdge * kEdge;
  static constexpr int kVoxels = kEdge * kEdge * kEdge;
  using Row =
      std::conditional_t<kEdge == 8, uint8_t, std::conditional_t<kEdge == 16, uint16_t, uint32_t>>;

  static VoxelIndex block(const VoxelIndex& v) { return coarser(v, kShift); }
  static int column(const VoxelIndex& v) { return v.x & (kEdge - 1); }
  static int row(const VoxelIndex& v) { return (v.z & (kEdge - 1)) * kEdge + (v.y & (kEdge - 1)); }
  static int cell(const VoxelIndex& v) { return row(v) * kEdge + column(v); }
  static VoxelIndex voxel(const VoxelIndex& block, int row, int column) {
    return {block.x * kEdge + column, block.y * kEdge + (row & (kEdge - 1)),
            block.z * kEdge + (row >> kShift)};
  }

  using Bits = std::array<Row, kRows>;  ///< row z * kEdge + y, bit x
  static bool test(const Bits& bits, const VoxelIndex& v) {
    return (bits[static_cast<size_t>(row(v))] >> column(v)) & 1U;
  }
  static bool isEmpty(const Bits& bits) {
    return std::all_of(bits.begin(), bits.end(), [](Row row) { return row == 0; });
  }
};

/// A set of voxels. Cleared blocks keep their memory for the next use.
template <int kEdge>
class BitGrid {
 public:
  using Layout = BlockLayout<kEdge>;
  using Row = typename Layout::Row;
  using Block = typename Layout::Bits;

  bool test(const VoxelIndex& v) const {
    const int32_t slot = table_.find(Layout::block(v));
    return slot != BlockTable::kNone && Layout::test(blocks_[static_cast<size_t>(slot)], v);
  }

  /// True if the voxel was not in the set.
  bool set(const VoxelIndex& v) {
    Row& row = blocks_[insertBlock(Layout::block(v))][Layout::row(v)];
    const Row bit = bitOf(v);
    const bool added = (row & bit) == 0;
    row = static_cast<Row>(row | bit);
    return added;
  }

  /// True if the voxel was in the set.
  bool reset(const VoxelIndex& v) {
    const int32_t slot = table_.find(Layout::block(v));
    if (slot == BlockTable::kNone) return false;
    Row& row = blocks_[static_cast<size_t>(slot)][Layout::row(v)];
    const Row bit = bitOf(v);
    const bool removed = (row & bit) != 0;
    row = static_cast<Row>(row & ~bit);
    return removed;
  }

  /// The slot of a block, made empty if it is new.
  size_t insertBlock(const VoxelIndex& block) {
    if (used_ != 0 && block == last_index_) return last_slot_;
    last_index_ = block;
    last_slot_ = static_cast<size_t>(table_.findOrInsert(block));
    if (last_slot_ == used_) {
      if (used_ == blocks_.size()) blocks_.emplace_back();
      blocks_[used_++].fill(0);
    }
    return last_slot_;
  }

  /// Null when the block holds nothing.
  const Block* findBlock(const VoxelIndex& block) const {
    const int32_t slot = table_.find(block);
    return slot == BlockTable::kNone ? nullptr : &blocks_[static_cast<size_t>(slot)];
  }

  size_t blockCount() const { return used_; }
  const VoxelIndex& blockIndex(size_t slot) const { return table_.block(slot); }
  const Block& block(size_t slot) const { return blocks_[slot]; }
  Block& block(size_t slot) { return blocks_[slot]; }

  size_t voxelCount() const {
    size_t count = 0;
    for (size_t slot = 0; slot < used_; ++slot) {
      for (const Row row : blocks_[slot]) {
        if (row != 0) count += static_cast<size_t>(__builtin_popcount(row));
      }
    }
    return count;
  }

  /// Calls visit(VoxelIndex) in a fixed order.
  template <typename Visit>
  void forEach(Visit&& visit) const {
    for (size_t slot = 0; slot < used_; ++slot) {
      forEachInBlock(blockIndex(slot), blocks_[slot], visit);
    }
  }

  template <typename Visit>
  static void forEachInBlock(const VoxelIndex& index, const Block& block, Visit&& visit) {
    for (int row = 0; row < Layout::kRows; ++row) {
      for (uint32_t bits = block[static_cast<size_t>(row)]; bits != 0; bits &= bits - 1) {
        visit(Layout::voxel(index, row, __builtin_ctz(bits)));
      }
    }
  }

  void clear() {
    table_.clear();
    used_ = 0;
  }

  size_t bytes() const { return table_.bytes() + blocks_.size() * sizeof(Block); }

 private:
  static Row bitOf(const VoxelIndex& v) { return static_cast<Row>(1U << Layout::column(v)); }

  BlockTable table_;
  std::deque<Block> blocks_;  // the first used_ belong to the table's slots
  size_t used_ = 0;
  VoxelIndex last_index_;  // of the last insertBlock()
  size_t last_slot_ = 0;
};

/// From a voxel to a number given at its insertion: where its data are kept.
template <int kEdge>
class SlotGrid {
 public:
  using Layout = BlockLayout<kEdge>;
  using Row = typename Layout::Row;
  static constexpr uint32_t kNone = 0xffffffff;

  struct Block {
    typename Layout::Bits occupied;
    std::array<uint32_t, Layout::kVoxels> slot;  ///< kNone where no voxel has been
  };

  /// The voxel's slot; a new voxel gets `next`, one that was erased the slot it had.
  uint32_t insert(const VoxelIndex& v, uint32_t next) {
    Block& block = blockOf(Layout::block(v));
    Row& row = block.occupied[static_cast<size_t>(Layout::row(v))];
    uint32_t& slot = block.slot[static_cast<size_t>(Layout::cell(v))];
    const auto bit = static_cast<Row>(1U << Layout::column(v));
    if ((row & bit) == 0) {
      row = static_cast<Row>(row | bit);
      if (slot == kNone) slot = next;
    }
    return slot;
  }

  void erase(const VoxelIndex& v) {
    const int32_t block = findBlock(Layout::block(v));
    if (block == BlockTable::kNone) return;
    Row& row = blocks_[static_cast<size_t>(block)].occupied[static_cast<size_t>(Layout::row(v))];
    row = static_cast<Row>(row & ~(1U << Layout::column(v)));
  }

  uint32_t find(const VoxelIndex& v) const {
    const int32_t block = findBlock(Layout::block(v));
    if (block == BlockTable::kNone) return kNone;
    return slotIn(blocks_[static_cast<size_t>(block)], v);
  }

  static uint32_t slotIn(const Block& block, const VoxelIndex& v) {
    const bool set = Layout::test(block.occupied, v);
    return set ? block.slot[static_cast<size_t>(Layout::cell(v))] : kNone;
  }

  /// Calls visit(slot) for the voxels of a block in a fixed order.
  template <typename Visit>
  void forEachInBlock(size_t block, Visit&& visit) const {
    const Block& b = blocks_[block];
    for (size_t row = 0; row < b.occupied.size(); ++row) {
      for (uint32_t bits = b.occupied[row]; bits != 0; bits &= bits - 1) {
        visit(b.slot[row * kEdge + static_cast<size_t>(__builtin_ctz(bits))]);
      }
    }
  }

  /// BlockTable::kNone if there is none.
  int32_t findBlock(const VoxelIndex& block) const { return table_.find(block); }
  size_t blockCount() const { return table_.size(); }
  const VoxelIndex& blockIndex(size_t block) const { return table_.block(block); }
  const Block& block(size_t block) const { return blocks_[block]; }

  void clear() {
    table_.clear();
    last_ = kNoBlock;
  }

  size_t bytes() const { return table_.bytes() + blocks_.size() * sizeof(Block); }

 private:
  static constexpr size_t kNoBlock = static_cast<size_t>(-1);

  Block& blockOf(const VoxelIndex& block) {
    if (last_ != kNoBlock && block == last_index_) return blocks_[last_];
    const size_t known = table_.size();
    last_ = static_cast<size_t>(table_.findOrInsert(block));
    last_index_ = block;
    if (last_ == blocks_.size()) blocks_.emplace_back();
    if (last_ == known) {
      blocks_[last_].occupied.fill(0);
      blocks_[last_].slot.fill(kNone);
    }
    return blocks_[last_];
  }

  BlockTable table_;
  std::deque<Block> blocks_;  // the first table_.size() are in use
  size_t last_ = kNoBlock;
  VoxelIndex last_index_;
};

}  // namespace edgevox
