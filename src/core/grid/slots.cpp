// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/grid/slots.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "edgevox/archive.hpp"

namespace edgevox {

uint32_t Slots::next(Kind kind) const {
  if (!free_[kind].empty()) return free_[kind].back();
  return fresh_[kind] < fresh_end_[kind] ? fresh_[kind] : static_cast<uint32_t>(end());
}

uint32_t Slots::take(Kind kind) {
  const uint32_t slot = next(kind);
  if (!free_[kind].empty()) {
    free_[kind].pop_back();
  } else {
    if (slot == end()) {
      chunks_.push_back({kind, 0});
      fresh_end_[kind] = static_cast<uint32_t>(end());
    }
    fresh_[kind] = slot + 1;
  }
  if (chunks_[slot / kChunk].used++ == 0) ++used_chunks_[kind];
  ++used_[kind];
  return slot;
}

void Slots::giveBack(uint32_t slot) {
  Chunk& chunk = chunks_[slot / kChunk];
  free_[chunk.kind].push_back(slot);
  --used_[chunk.kind];
  if (--chunk.used == 0) --used_chunks_[chunk.kind];
}

size_t Slots::freeCount(Kind kind) const {
  const size_t unused = used_chunks_[kind] * kChunk - used_[kind];
  const bool open = fresh_[kind] < fresh_end_[kind] && !isChunkFree(fresh_[kind]);
  return open ? unused - (fresh_end_[kind] - fresh_[kind]) : unused;
}

/// Every slot is used, free, or was never given out, which is the end of the last chunk of a kind.
void Slots::checkRead(const std::vector<bool>& used) {
  const auto require = [](bool good) {
    if (!good) throw ArchiveError("the free places do not fit to those in use");
  };
  require(used.size() == end() && end() <= std::numeric_limits<uint32_t>::max());
  countUsed(used);
  std::vector<bool> known = used;
  const auto mark = [&](uint32_t slot, int kind) {
    require(slot < end() && kindOf(slot) == kind && !known[slot]);
    known[slot] = true;
  };
  for (const int kind : {kNear, kFar}) {
    for (const uint32_t slot : free_[kind]) mark(slot, kind);
    require(fresh_[kind] <= fresh_end_[kind] && fresh_end_[kind] - fresh_[kind] < kChunk);
    for (uint32_t slot = fresh_[kind]; slot < fresh_end_[kind]; ++slot) mark(slot, kind);
  }
  require(std::find(known.begin(), known.end(), false) == known.end());
}

void Slots::countUsed(const std::vector<bool>& used) {
  fresh_end_ = {};
  used_ = {};
  used_chunks_ = {};
  for (size_t c = 0; c < chunks_.size(); ++c) {
    Chunk& chunk = chunks_[c];
    if (chunk.kind != kNear && chunk.kind != kFar) throw ArchiveError("a place of unknown kind");
    const auto first = used.begin() + static_cast<std::ptrdiff_t>(c * kChunk);
    chunk.used = static_cast<uint32_t>(std::count(first, first + kChunk, true));
    fresh_end_[chunk.kind] = static_cast<uint32_t>((c + 1) * kChunk);
    used_[chunk.kind] += chunk.used;
    used_chunks_[chunk.kind] += chunk.used > 0 ? 1 : 0;
  }
}

size_t Slots::bytes() const {
  return chunks_.capacity() * sizeof(Chunk) +
         (free_[kNear].capacity() + free_[kFar].capacity()) * sizeof(uint32_t);
}

}  // namespace edgevox
