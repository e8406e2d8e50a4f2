// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "edgevox/grid/pool.hpp"

namespace edgevox {

/// Gives out places in Pools that share their numbering, and takes them back: the last one given
/// back is the next one given out. Slots of the two kinds never share a chunk, so that a Pool that
/// holds data of one kind alone needs no memory for the other.
class Slots {
 public:
  enum Kind : uint8_t { kNear, kFar };

  /// What the next take() gives.
  uint32_t next(Kind kind) const;
  uint32_t take(Kind kind);
  void giveBack(uint32_t slot);

  Kind kindOf(uint32_t slot) const { return chunks_[slot / kChunk].kind; }
  /// Whether no slot of the slot's chunk is given out.
  bool isChunkFree(uint32_t slot) const { return chunks_[slot / kChunk].used == 0; }
  /// Drops the data of a chunk of which no slot is given out.
  template <typename T>
  void dropIfFree(uint32_t slot, Pool<T>& data) const {
    const size_t begin = slot / kChunk * kChunk;
    if (isChunkFree(slot)) data.drop(begin, begin + kChunk);
  }
  /// A number above all slots, of which some may be free.
  size_t end() const { return chunks_.size() * kChunk; }
  /// The number of slots given back, of a kind, in chunks of which others are given out.
  size_t freeCount(Kind kind) const;
  size_t usedCount(Kind kind) const { return used_[kind]; }
  size_t bytes() const;

  /// checkRead() must follow.
  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.chunks_, self.free_, self.fresh_);
  }
  /// Throws ArchiveError unless the slots given out are those `used`, one a slot below end().
  void checkRead(const std::vector<bool>& used);

 private:
  static constexpr size_t kChunk = kPoolUnit;

  struct Chunk {
    Kind kind = kNear;
    uint32_t used = 0;

    template <typename Self, typename Archive>
    static void archive(Self& self, Archive& bytes) {
      bytes(self.kind);
    }
  };

  void countUsed(const std::vector<bool>& used);

  std::vector<Chunk> chunks_;
  std::array<std::vector<uint32_t>, 2> free_;  // by kind, given back
  std::array<uint32_t, 2> fresh_{};            // next that was never given out
  std::array<uint32_t, 2> fresh_end_{};
  std::array<size_t, 2> used_{};
  std::array<size_t, 2> used_chunks_{};
};

}  // namespace edgevox
