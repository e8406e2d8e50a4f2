// SPDX-License-Identifier: BSD-3-Clause
// Semi-sparse voxel grids (Ryde et al. 2013, III-C): blocks found by hash, dense bits inside.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <type_traits>
#include <vector>

#include "edgevox/archive.hpp"
#include "edgevox/grid/pool.hpp"
#include "edgevox/grid/voxel.hpp"

namespace edgevox {

/// Different in every process, so that nobody can choose coordinates that collide in a hash.
uint64_t hashSecret();

/// Open-addressing hash from a block's index to its slot; slots are 0, 1, 2, ... in order of
/// insertion, but that of the block erased last is used first, so that the order of iteration
/// depends on the input alone, not on the hash. A search looks at no more than kMaxProbes buckets
/// beside the first.
class BlockTable {
 public:
  static constexpr int32_t kNone = -1;
  static constexpr VoxelIndex kErased{1 << 25, 1 << 25, 1 << 25};  ///< outside of every grid

  explicit BlockTable(uint64_t seed = hashSecret()) : seed_(seed), buckets_(kMinBuckets, kNone) {}

  int32_t find(const VoxelIndex& block) const {
    for (size_t b = firstBucket(block);; b = next(b)) {
      const int32_t slot = buckets_[b];
      if (slot == kNone || blocks_[static_cast<size_t>(slot)] == block) return slot;
    }
  }

  int32_t findOrInsert(const VoxelIndex& block) {
    size_t b = firstBucket(block);
    size_t probes = 0;
    for (; buckets_[b] != kNone; b = next(b), ++probes) {
      if (blocks_[static_cast<size_t>(buckets_[b])] == block) return buckets_[b];
    }
    const int32_t slot = takeSlot(block);
    buckets_[b] = slot;
    if (isOverfull() || probes > kMaxProbes) {
      rehash(isOverfull() ? 2 * buckets_.size() : buckets_.size());
    }
    return slot;
  }

  /// The block must be known; its slot becomes free and holds kErased until it is used again.
  void erase(const VoxelIndex& block) {
    size_t hole = firstBucket(block);
    while (blocks_[static_cast<size_t>(buckets_[hole])] != block) hole = next(hole);
    free_.push_back(buckets_[hole]);
    blocks_[static_cast<size_t>(buckets_[hole])] = kErased;
    for (size_t b = next(hole); buckets_[b] != kNone; b = next(b)) {
      const size_t first = firstBucket(blocks_[static_cast<size_t>(buckets_[b])]);
      if (distance(first, b) < distance(hole, b)) continue;
      buckets_[hole] = buckets_[b];
      hole = b;
    }
    buckets_[hole] = kNone;
  }

  /// A number above all slots, of which some may be free.
  size_t size() const { return blocks_.size(); }
  size_t freeCount() const { return free_.size(); }
  /// The block of a slot; kErased if it is free.
  const VoxelIndex& block(size_t slot) const { return blocks_[slot]; }
  /// Buckets that a search for a known block looks at in vain.
  size_t probes(const VoxelIndex& block) const {
    size_t count = 0;
    for (size_t b = firstBucket(block); blocks_[static_cast<size_t>(buckets_[b])] != block;
         b = next(b)) {
      ++count;
    }
    return count;
  }

  void clear() {
    blocks_.clear();
    free_.clear();
    buckets_.assign(buckets_.size(), kNone);
  }

  size_t bytes() const {
    return (buckets_.capacity() + free_.capacity()) * sizeof(int32_t) +
           blocks_.capacity() * sizeof(VoxelIndex);
  }

  /// The blocks in their order; the hash is made anew. Throws ArchiveError if one is out of the
  /// grid's range or there twice, or if the free slots are not those of erased blocks.
  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.blocks_, self.free_);
    if constexpr (Archive::kReads) self.insertAgain();
  }

 private:
  void insertAgain();
  void requireFree(const std::vector<int32_t>& free) const;

  static constexpr size_t kMinBuckets = 64;
  // Half full, a table of a million random blocks has no search as long.
  static constexpr size_t kMaxProbes = 128;

  size_t firstBucket(const VoxelIndex& block) const {
    return mixBits(packedIndex(block) ^ seed_) & (buckets_.size() - 1);
  }
  size_t next(size_t bucket) const { return (bucket + 1) & (buckets_.size() - 1); }
  size_t distance(size_t from, size_t to) const { return (to - from) & (buckets_.size() - 1); }

  bool isOverfull() const { return 2 * (blocks_.size() - free_.size()) > buckets_.size(); }

  int32_t takeSlot(const VoxelIndex& block) {
    if (free_.empty()) {
      blocks_.push_back(block);
      return static_cast<int32_t>(blocks_.size()) - 1;
    }
    const int32_t slot = free_.back();
    free_.pop_back();
    blocks_[static_cast<size_t>(slot)] = block;
    return slot;
  }

  /// Fills the table anew, by another hash if this one needs too long searches.
  void rehash(size_t bucket_count) {
    while (!fill(bucket_count)) seed_ = mixBits(seed_ + 1);
  }

  bool fill(size_t bucket_count) {
    buckets_.assign(bucket_count, kNone);
    for (size_t slot = 0; slot < blocks_.size(); ++slot) {
      if (blocks_[slot] == kErased) continue;
      size_t b = firstBucket(blocks_[slot]);
      size_t probes = 0;
      for (; buckets_[b] != kNone; b = next(b)) ++probes;
      if (probes > kMaxProbes) return false;
      buckets_[b] = static_cast<int32_t>(slot);
    }
    return true;
  }

  uint64_t seed_;                 // of the hash
  std::vector<int32_t> buckets_;  // a power of two, at most half full
  std::vector<VoxelIndex> blocks_;
  std::vector<int32_t> free_;  // slots of erased blocks
};

/// The number of bits set, without an instruction that some processors lack.
inline size_t bitCount(uint64_t bits) {
  bits -= (bits >> 1) & 0x5555555555555555ULL;
  bits = (bits & 0x3333333333333333ULL) + ((bits >> 2) & 0x3333333333333333ULL);
  bits = (bits + (bits >> 4)) & 0x0f0f0f0f0f0f0f0fULL;
  return (bits * 0x0101010101010101ULL) >> 56;
}

/// The place of a voxel inside a block of kSide voxels a side.
template <int kSide>
struct BlockLayout {
  static_assert(kSide == 8 || kSide == 16 || kSide == 32, "a row of voxels is one word");
  static constexpr int kShift = kSide == 8 ? 3 : kSide == 16 ? 4 : 5;
  static constexpr int kRows = kSide * kSide;
  static constexpr int kVoxels = kSide * kSide * kSide;
  using Row =
      std::conditional_t<kSide == 8, uint8_t, std::conditional_t<kSide == 16, uint16_t, uint32_t>>;

  static VoxelIndex block(const VoxelIndex& v) { return coarser(v, kShift); }
  static int column(const VoxelIndex& v) { return v.x & (kSide - 1); }
  static int row(const VoxelIndex& v) { return (v.z & (kSide - 1)) * kSide + (v.y & (kSide - 1)); }
  static int cell(const VoxelIndex& v) { return row(v) * kSide + column(v); }
  static VoxelIndex voxel(const VoxelIndex& block, int row, int column) {
    return {block.x * kSide + column, block.y * kSide + (row & (kSide - 1)),
            block.z * kSide + (row >> kShift)};
  }

  using Bits = std::array<Row, kRows>;  ///< row z * kSide + y, bit x
  static bool test(const Bits& bits, const VoxelIndex& v) {
    return (bits[static_cast<size_t>(row(v))] >> column(v)) & 1U;
  }
  static bool isEmpty(const Bits& bits) {
    return std::all_of(bits.begin(), bits.end(), [](Row row) { return row == 0; });
  }
};

/// A set of voxels. Cleared blocks keep their memory for the next use. Copies share theirs: see
/// Pool.
template <int kSide>
class BitGrid {
 public:
  using Layout = BlockLayout<kSide>;
  using Row = typename Layout::Row;
  using Block = typename Layout::Bits;

  bool test(const VoxelIndex& v) const {
    const int32_t slot = table_.find(Layout::block(v));
    return slot != BlockTable::kNone && Layout::test(blocks_[static_cast<size_t>(slot)], v);
  }

  /// Adds a voxel; true if it was not in the set.
  bool set(const VoxelIndex& v) {
    const size_t slot = insertBlock(Layout::block(v));
    if (Layout::test(blocks_[slot], v)) return false;
    flip(slot, v);
    return true;
  }

  /// Takes a voxel out; true if it was in the set.
  bool reset(const VoxelIndex& v) {
    const int32_t slot = table_.find(Layout::block(v));
    if (slot == BlockTable::kNone) return false;
    if (!Layout::test(blocks_[static_cast<size_t>(slot)], v)) return false;
    flip(static_cast<size_t>(slot), v);
    return true;
  }

  /// The slot of a block, made empty if it is new.
  size_t insertBlock(const VoxelIndex& block) {
    if (used_ != 0 && block == last_index_) return last_slot_;
    last_index_ = block;
    last_slot_ = static_cast<size_t>(table_.findOrInsert(block));
    if (last_slot_ == used_) {
      if (used_ == blocks_.size()) blocks_.grow();
      blocks_.edit(used_++).fill(0);
    }
    return last_slot_;
  }

  /// Takes a block with all its voxels out; its memory is used for the next new one.
  void eraseBlock(const VoxelIndex& block) {
    const int32_t slot = table_.find(block);
    if (slot == BlockTable::kNone) return;
    blocks_.edit(static_cast<size_t>(slot)).fill(0);
    table_.erase(block);
    last_index_ = BlockTable::kErased;
  }

  /// The bits of a block; null when the block holds nothing.
  const Block* findBlock(const VoxelIndex& block) const {
    const int32_t slot = table_.find(block);
    return slot == BlockTable::kNone ? nullptr : &blocks_[static_cast<size_t>(slot)];
  }

  /// Erased blocks count until they are used again; they are empty and have no index.
  size_t blockCount() const { return used_; }
  const VoxelIndex& blockIndex(size_t slot) const { return table_.block(slot); }
  const Block& block(size_t slot) const { return blocks_[slot]; }
  /// To be written to; stays where it is until the grid is copied.
  Block& editBlock(size_t slot) { return blocks_.edit(slot); }

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

  /// Calls visit(slot) for the blocks that differ from those of `earlier`, a copy of this grid made
  /// since it was last cleared; no block may have been erased since. What is shared takes no time.
  template <typename Visit>
  void forEachChangedBlock(const BitGrid& earlier, Visit&& visit) const {
    blocks_.forEachNotShared(earlier.blocks_, [&](size_t slot) {
      if (slot >= used_) return;
      const bool known = slot < earlier.used_;
      if (known ? blocks_[slot] != earlier.blocks_[slot] : !Layout::isEmpty(blocks_[slot])) {
        visit(slot);
      }
    });
  }

  size_t bytes() const { return table_.bytes() + blocks_.bytes(); }
  /// The part of bytes() that erased blocks took and new ones will.
  size_t freeBytes() const { return table_.freeCount() * sizeof(Block); }

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.table_);
    if constexpr (Archive::kReads) self.makeBlocks();
    for (size_t slot = 0; slot < self.used_; ++slot) {
      Pool<Block>::archiveElement(self.blocks_, slot, bytes);
    }
    if constexpr (Archive::kReads) self.checkRead();
  }

 private:
  void flip(size_t slot, const VoxelIndex& v) {
    Row& row = blocks_.edit(slot)[static_cast<size_t>(Layout::row(v))];
    row = static_cast<Row>(row ^ (1U << Layout::column(v)));
  }

  void makeBlocks() {
    used_ = table_.size();
    while (blocks_.size() < used_) blocks_.grow();
    last_index_ = BlockTable::kErased;
  }
  void checkRead() const {
    for (size_t slot = 0; slot < used_; ++slot) {
      if (blockIndex(slot) == BlockTable::kErased && !Layout::isEmpty(blocks_[slot])) {
        throw ArchiveError("an erased block has voxels");
      }
    }
  }

  BlockTable table_;
  Pool<Block> blocks_;  // the first used_ belong to the table's slots
  size_t used_ = 0;
  VoxelIndex last_index_;  // of the last insertBlock()
  size_t last_slot_ = 0;
};

/// Tests voxels that lie near one another: the block of the last one is kept.
template <int kSide>
class BitReader {
 public:
  /// `grid` must outlive this and stay as it is.
  explicit BitReader(const BitGrid<kSide>& grid) : grid_(grid) {}

  bool test(const VoxelIndex& v) {
    const VoxelIndex block = BitGrid<kSide>::Layout::block(v);
    if (!known_ || block != index_) block_ = grid_.findBlock(block);
    known_ = true;
    index_ = block;
    return block_ != nullptr && BitGrid<kSide>::Layout::test(*block_, v);
  }

 private:
  const BitGrid<kSide>& grid_;
  const typename BitGrid<kSide>::Block* block_ = nullptr;
  VoxelIndex index_;
  bool known_ = false;
};

/// Gives for a voxel a number set at its insertion: where its data are kept. A block holds the
/// numbers of its voxels and no others, so that a voxel on its own is small.
template <int kSide>
class SlotGrid {
 public:
  using Layout = BlockLayout<kSide>;
  static constexpr uint32_t kNone = 0xffffffff;

  /// A bit a cell of a block.
  class Bits {
   public:
    bool test(int cell) const { return (words_[wordOf(cell)] >> (cell & 63)) & 1U; }
    void set(int cell) { words_[wordOf(cell)] |= uint64_t{1} << (cell & 63); }
    void reset(int cell) { words_[wordOf(cell)] &= ~(uint64_t{1} << (cell & 63)); }
    void flip(int cell) { words_[wordOf(cell)] ^= uint64_t{1} << (cell & 63); }
    uint64_t word(size_t at) const { return words_[at]; }
    bool any() const {
      return std::any_of(words_.begin(), words_.end(), [](uint64_t word) { return word != 0; });
    }
    /// Bits in the cell's word before the cell.
    size_t countBefore(int cell) const {
      return bitCount(words_[wordOf(cell)] & ((uint64_t{1} << (cell & 63)) - 1));
    }

    static constexpr size_t kWords = Layout::kVoxels / 64;
    static size_t wordOf(int cell) { return static_cast<size_t>(cell >> 6); }
    bool isSubsetOf(const Bits& other) const {
      return std::equal(words_.begin(), words_.end(), other.words_.begin(),
                        [](uint64_t a, uint64_t b) { return (a & ~b) == 0; });
    }
    size_t count() const {
      return std::accumulate(words_.begin(), words_.end(), size_t{0},
                             [](size_t sum, uint64_t word) { return sum + bitCount(word); });
    }

    template <typename Self, typename Archive>
    static void archive(Self& self, Archive& bytes) {
      bytes(self.words_);
    }

   private:
    std::array<uint64_t, kWords> words_{};
  };

  struct Block {
    Bits occupied;
    std::array<uint16_t, Bits::kWords> before{};  ///< occupied cells in the words before
    std::vector<uint32_t> slots;                  ///< of the occupied cells, in their order

    size_t rank(int cell) const { return before[Bits::wordOf(cell)] + occupied.countBefore(cell); }
    uint32_t slotOf(int cell) const { return slots[rank(cell)]; }

    template <typename Self, typename Archive>
    static void archive(Self& self, Archive& bytes) {
      bytes(self.occupied, self.slots);
      if constexpr (Archive::kReads) self.countWords();
    }

   private:
    void countWords() {
      if (slots.size() != occupied.count()) throw ArchiveError("a block lacks a voxel");
      for (size_t w = 1; w < Bits::kWords; ++w) {
        before[w] = static_cast<uint16_t>(before[w - 1] + bitCount(occupied.word(w - 1)));
      }
    }
  };

  /// The voxel's slot; a new voxel gets `next`.
  uint32_t insert(const VoxelIndex& v, uint32_t next) {
    const size_t found = insertBlock(Layout::block(v));
    const int cell = Layout::cell(v);
    if (const Block& known = blocks_[found]; known.occupied.test(cell)) return known.slotOf(cell);
    Block& block = blocks_.edit(found);
    slot_bytes_ -= bytesOf(block.slots);
    block.slots.insert(block.slots.begin() + static_cast<std::ptrdiff_t>(block.rank(cell)), next);
    slot_bytes_ += bytesOf(block.slots);
    block.occupied.set(cell);
    for (size_t w = Bits::wordOf(cell) + 1; w < Bits::kWords; ++w) ++block.before[w];
    return next;
  }

  void erase(const VoxelIndex& v) {
    const int32_t found = findBlock(Layout::block(v));
    if (found == BlockTable::kNone) return;
    const int cell = Layout::cell(v);
    if (!blocks_[static_cast<size_t>(found)].occupied.test(cell)) return;
    Block& block = blocks_.edit(static_cast<size_t>(found));
    if (block.slots.size() == 1) return eraseBlock(Layout::block(v));
    slot_bytes_ -= bytesOf(block.slots);
    block.slots.erase(block.slots.begin() + static_cast<std::ptrdiff_t>(block.rank(cell)));
    slot_bytes_ += bytesOf(block.slots);
    block.occupied.reset(cell);
    for (size_t w = Bits::wordOf(cell) + 1; w < Bits::kWords; ++w) --block.before[w];
  }

  /// Takes a block with all its voxels out; what it held apart from the slots is used for the next
  /// new one.
  void eraseBlock(const VoxelIndex& index) {
    const int32_t found = findBlock(index);
    if (found == BlockTable::kNone) return;
    Block& block = blocks_.edit(static_cast<size_t>(found));
    slot_bytes_ -= bytesOf(block.slots);
    block = {};
    table_.erase(index);
    last_ = kNoBlock;
  }

  /// Gives a voxel that has a slot another one.
  void setSlot(const VoxelIndex& v, uint32_t slot) {
    Block& block = blocks_.edit(static_cast<size_t>(findBlock(Layout::block(v))));
    block.slots[block.rank(Layout::cell(v))] = slot;
  }

  /// Gives the memory back that a block holds for more voxels than it has; bytes() counts none.
  void shrinkBlock(size_t block) {
    const std::vector<uint32_t>& slots = blocks_[block].slots;
    if (slots.capacity() == slots.size()) return;
    std::vector<uint32_t>& shrunk = blocks_.edit(block).slots;
    std::vector<uint32_t>(shrunk).swap(shrunk);
  }

  uint32_t find(const VoxelIndex& v) const {
    const int32_t block = findBlock(Layout::block(v));
    if (block == BlockTable::kNone) return kNone;
    return slotIn(blocks_[static_cast<size_t>(block)], v);
  }

  static uint32_t slotIn(const Block& block, const VoxelIndex& v) {
    const int cell = Layout::cell(v);
    return block.occupied.test(cell) ? block.slotOf(cell) : kNone;
  }

  /// Calls visit(slot) for the voxels of a block in a fixed order.
  template <typename Visit>
  void forEachInBlock(size_t block, Visit&& visit) const {
    for (const uint32_t slot : blocks_[block].slots) visit(slot);
  }

  /// Calls visit(VoxelIndex, slot) in the same order.
  template <typename Visit>
  void forEachVoxelInBlock(size_t block, Visit&& visit) const {
    const Block& of = blocks_[block];
    for (int cell = 0, rank = 0; rank < static_cast<int>(of.slots.size()); ++cell) {
      if (!of.occupied.test(cell)) continue;
      visit(Layout::voxel(blockIndex(block), cell / kSide, cell % kSide),
            of.slots[static_cast<size_t>(rank++)]);
    }
  }

  /// BlockTable::kNone if there is none.
  int32_t findBlock(const VoxelIndex& block) const { return table_.find(block); }
  /// Erased blocks count until they are used again.
  size_t blockCount() const { return table_.size(); }
  const VoxelIndex& blockIndex(size_t block) const { return table_.block(block); }
  const Block& block(size_t block) const { return blocks_[block]; }

  void clear() { *this = {}; }

  size_t bytes() const { return table_.bytes() + blocks_.bytes() + slot_bytes_; }
  /// The part of bytes() that erased blocks took and new ones will.
  size_t freeBytes() const { return table_.freeCount() * sizeof(Block); }

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.table_);
    if constexpr (Archive::kReads) self.makeBlocks();
    for (size_t block = 0; block < self.blockCount(); ++block) {
      Pool<Block>::archiveElement(self.blocks_, block, bytes);
    }
    if constexpr (Archive::kReads) self.checkRead();
  }

 private:
  void makeBlocks() {
    blocks_ = {};
    while (blocks_.size() < table_.size()) blocks_.grow();
    last_ = kNoBlock;
  }
  void checkRead() {
    slot_bytes_ = 0;
    for (size_t block = 0; block < blockCount(); ++block) {
      slot_bytes_ += bytesOf(blocks_[block].slots);
      if (blocks_[block].slots.empty() != (blockIndex(block) == BlockTable::kErased)) {
        throw ArchiveError("a block has no voxel");
      }
    }
  }

  static constexpr size_t kNoBlock = static_cast<size_t>(-1);

  /// Of a vector that doubles, by its size: one that was cloned has less room, but whether a map is
  /// full must not depend on its copies.
  static size_t bytesOf(const std::vector<uint32_t>& slots) {
    if (slots.empty()) return 0;
    const size_t room = powerOfTwoWithin(slots.size());
    return (room < slots.size() ? 2 * room : room) * sizeof(uint32_t);
  }

  size_t insertBlock(const VoxelIndex& block) {
    if (last_ != kNoBlock && block == last_index_) return last_;
    last_ = static_cast<size_t>(table_.findOrInsert(block));
    last_index_ = block;
    if (last_ == blocks_.size()) blocks_.grow();
    return last_;
  }

  BlockTable table_;
  Pool<Block> blocks_;
  size_t slot_bytes_ = 0;
  size_t last_ = kNoBlock;
  VoxelIndex last_index_;
};

}  // namespace edgevox
