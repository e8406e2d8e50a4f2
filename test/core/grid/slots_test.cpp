// SPDX-License-Identifier: BSD-3-Clause
// Slots, Pools and blocks that are given back and used again.
#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "edgevox/archive.hpp"
#include "edgevox/grid/block_grid.hpp"
#include "edgevox/grid/pool.hpp"
#include "edgevox/grid/slots.hpp"
#include "support/random.hpp"

namespace edgevox::test {
namespace {

TEST(Slots, AreCountedUpAndTheLastGivenBackComesFirst) {
  Slots slots;
  for (uint32_t i = 0; i < 5; ++i) {
    EXPECT_EQ(i, slots.next(Slots::kNear));
    EXPECT_EQ(i, slots.take(Slots::kNear));
  }
  slots.giveBack(1);
  slots.giveBack(3);
  EXPECT_EQ(3U, slots.take(Slots::kNear));
  EXPECT_EQ(1U, slots.take(Slots::kNear));
  EXPECT_EQ(5U, slots.take(Slots::kNear));
  EXPECT_EQ(6U, slots.usedCount(Slots::kNear));
  EXPECT_EQ(0U, slots.freeCount(Slots::kNear));
  slots.giveBack(2);
  EXPECT_EQ(1U, slots.freeCount(Slots::kNear));
}

TEST(Slots, OfTwoKindsShareNoChunk) {
  Slots slots;
  Random random(3);
  std::set<uint32_t> used;
  for (int i = 0; i < 20000; ++i) {
    if (!used.empty() && random.chance(0.4)) {
      const uint32_t slot = *used.begin();
      used.erase(used.begin());
      slots.giveBack(slot);
      EXPECT_EQ(used.lower_bound(slot / kPoolUnit * kPoolUnit) ==
                    used.lower_bound((slot / kPoolUnit + 1) * kPoolUnit),
                slots.isChunkFree(slot));
      continue;
    }
    const Slots::Kind kind = random.chance(0.3) ? Slots::kFar : Slots::kNear;
    const uint32_t slot = slots.take(kind);
    ASSERT_TRUE(used.insert(slot).second);
    ASSERT_EQ(kind, slots.kindOf(slot));
    ASSERT_LT(slot, slots.end());
  }
  EXPECT_EQ(used.size(), slots.usedCount(Slots::kNear) + slots.usedCount(Slots::kFar));
}

/// As large as a quarter of a kilobyte, so that many chunks are dropped at once.
using Large = std::array<int, 64>;

template <typename T>
class DroppedPool : public ::testing::Test {};
using Elements = ::testing::Types<std::array<char, 1>, std::array<int, 1>, Large>;
TYPED_TEST_SUITE(DroppedPool, Elements);

TYPED_TEST(DroppedPool, HoldsWhatIsNotDropped) {
  Pool<TypeParam> pool;
  constexpr size_t kFourth = 3 * kPoolUnit;
  pool.hold(kFourth + 1)[0] = 7;
  EXPECT_FALSE(pool.holds(0));
  EXPECT_TRUE(pool.holds(kFourth));
  EXPECT_FALSE(pool.holds(kFourth + kPoolUnit));
  const size_t bytes = pool.bytes();
  pool.hold(0)[0] = 5;
  EXPECT_EQ(2 * bytes, pool.bytes());
  const Pool<TypeParam> copy(pool);
  pool.drop(kFourth, kFourth + kPoolUnit);
  EXPECT_EQ(bytes, pool.bytes());
  EXPECT_EQ(2 * bytes, copy.bytes());
  EXPECT_FALSE(pool.holds(kFourth + 1));
  EXPECT_EQ(5, pool[0][0]);
  EXPECT_EQ(7, copy[kFourth + 1][0]);
  EXPECT_EQ(0, pool.hold(kFourth + 1)[0]);
  EXPECT_EQ(7, copy[kFourth + 1][0]);
}

TYPED_TEST(DroppedPool, IsReadAsItWasWritten) {
  Pool<TypeParam> pool;
  for (size_t i = 0; i < 4 * kPoolUnit + 5; ++i) pool.grow()[0] = static_cast<char>(i);
  pool.drop(kPoolUnit, 3 * kPoolUnit);
  pool.hold(2 * kPoolUnit)[0] = 3;
  ArchiveWriter writer;
  writer(pool);
  ArchiveReader reader(writer.bytes());
  Pool<TypeParam> again;
  reader(again);
  reader.requireEnd();
  ASSERT_EQ(pool.size(), again.size());
  EXPECT_EQ(pool.bytes(), again.bytes());
  for (size_t i = 0; i < pool.size(); ++i) {
    ASSERT_EQ(pool.holds(i), again.holds(i)) << i;
    if (pool.holds(i)) ASSERT_EQ(pool[i], again[i]) << i;
  }
}

/// `used`: those that are given out.
Slots readAgain(const Slots& slots, const std::vector<bool>& used) {
  ArchiveWriter writer;
  writer(slots);
  ArchiveReader reader(writer.bytes());
  Slots again;
  reader(again);
  reader.requireEnd();
  again.checkRead(used);
  return again;
}

TEST(Slots, GoOnAsTheyWereWritten) {
  Slots slots;
  Random random(7);
  std::vector<uint32_t> taken;
  for (int i = 0; i < 6000; ++i) {
    taken.push_back(slots.take(random.chance(0.5) ? Slots::kFar : Slots::kNear));
    if (random.chance(0.6)) continue;
    std::swap(taken.back(), taken[static_cast<size_t>(random.integer(0, 100)) % taken.size()]);
    slots.giveBack(taken.back());
    taken.pop_back();
  }
  std::vector<bool> used(slots.end());
  for (const uint32_t slot : taken) used[slot] = true;
  Slots again = readAgain(slots, used);
  for (const auto kind : {Slots::kNear, Slots::kFar}) {
    EXPECT_EQ(slots.usedCount(kind), again.usedCount(kind));
    EXPECT_EQ(slots.freeCount(kind), again.freeCount(kind));
    for (int i = 0; i < 3000; ++i) ASSERT_EQ(slots.take(kind), again.take(kind));
  }
}

TEST(Slots, ThatDoNotFitToThoseInUseAreRefused) {
  Slots slots;
  for (int i = 0; i < 10; ++i) slots.take(Slots::kNear);
  slots.giveBack(3);
  std::vector<bool> used(slots.end());
  std::fill(used.begin(), used.begin() + 10, true);
  EXPECT_THROW(readAgain(slots, used), ArchiveError) << "in use and free";
  used[3] = false;
  EXPECT_NO_THROW(readAgain(slots, used));
  used[4] = false;
  EXPECT_THROW(readAgain(slots, used), ArchiveError) << "neither";
  used[4] = true;
  used[20] = true;
  EXPECT_THROW(readAgain(slots, used), ArchiveError) << "never given out";
  used.pop_back();
  EXPECT_THROW(readAgain(slots, used), ArchiveError);
}

VoxelIndex randomVoxel(Random& random, int32_t limit) { return random.voxelIn(-limit, limit); }

TEST(BlockTable, FindsWhatIsThereAndNothingElse) {
  for (const uint64_t seed : {0, 1, 2}) {
    BlockTable table(seed);
    std::map<VoxelIndex, int32_t> expected;
    Random random(static_cast<uint32_t>(seed) + 11);
    size_t most = 0;
    for (int i = 0; i < 30000; ++i) {
      const VoxelIndex v = randomVoxel(random, 6);
      const auto found = expected.find(v);
      ASSERT_EQ(found == expected.end() ? BlockTable::kNone : found->second, table.find(v));
      if (found != expected.end() && random.chance(0.6)) {
        table.erase(v);
        ASSERT_EQ(BlockTable::kErased, table.block(static_cast<size_t>(found->second)));
        expected.erase(found);
      } else {
        expected[v] = table.findOrInsert(v);
      }
      most = std::max(most, expected.size());
    }
    EXPECT_EQ(most, table.size());  // slots are used again
    EXPECT_EQ(most - expected.size(), table.freeCount());
    for (const auto& [v, slot] : expected) {
      ASSERT_EQ(slot, table.find(v));
      ASSERT_EQ(v, table.block(static_cast<size_t>(slot)));
    }
    ArchiveWriter writer;
    writer(table);
    ArchiveReader reader(writer.bytes());
    BlockTable again(seed + 1);
    reader(again);
    for (const auto& [v, slot] : expected) ASSERT_EQ(slot, again.find(v));
    for (int i = 0; i < 5000; ++i) {
      const VoxelIndex v = randomVoxel(random, 9);
      ASSERT_EQ(table.findOrInsert(v), again.findOrInsert(v));
    }
    EXPECT_NEAR(static_cast<double>(table.bytes()), static_cast<double>(again.bytes()),
                sizeof(int32_t) * static_cast<double>(most));  // room for free slots
  }
}

TEST(BitGrid, ErasedBlocksAreEmptyAndUsedAgain) {
  BitGrid<16> grid;
  std::set<VoxelIndex> expected;
  Random random(17);
  for (int i = 0; i < 20000; ++i) {
    const VoxelIndex v = randomVoxel(random, 40);
    if (random.chance(0.01)) {
      grid.eraseBlock(coarser(v, 4));
      for (auto at = expected.begin(); at != expected.end();) {
        at = coarser(*at, 4) == coarser(v, 4) ? expected.erase(at) : std::next(at);
      }
    } else {
      ASSERT_EQ(expected.insert(v).second, grid.set(v));
    }
  }
  EXPECT_EQ(expected.size(), grid.voxelCount());
  grid.forEach([&](const VoxelIndex& v) { ASSERT_EQ(1U, expected.count(v)); });
  EXPECT_GE(216U, grid.blockCount());
}

TEST(SlotGrid, GivesTheMemoryOfBlocksBack) {
  SlotGrid<8> grid;
  std::map<VoxelIndex, uint32_t> expected;
  Random random(19);
  uint32_t next = 0;
  for (int i = 0; i < 20000; ++i) {
    const VoxelIndex v = randomVoxel(random, 12);
    const bool known = expected.count(v) > 0;
    if (random.chance(0.5)) {
      expected.erase(v);
      grid.erase(v);
    } else if (known && random.chance(0.5)) {
      grid.setSlot(v, expected[v] = ++next);
    } else if (random.chance(0.02)) {
      grid.eraseBlock(coarser(v, 3));
      for (auto at = expected.begin(); at != expected.end();) {
        at = coarser(at->first, 3) == coarser(v, 3) ? expected.erase(at) : std::next(at);
      }
    } else {
      if (!known) expected[v] = ++next;
      ASSERT_EQ(expected[v], grid.insert(v, next));
    }
  }
  size_t count = 0;
  for (size_t block = 0; block < grid.blockCount(); ++block) {
    if (grid.blockIndex(block) == BlockTable::kErased) continue;
    grid.shrinkBlock(block);
    grid.forEachVoxelInBlock(block, [&](const VoxelIndex& v, uint32_t slot) {
      ASSERT_EQ(expected.at(v), slot);
      ++count;
    });
  }
  EXPECT_EQ(expected.size(), count);
  const size_t bytes = grid.bytes();
  for (const auto& [v, slot] : expected) {
    ASSERT_EQ(slot, grid.find(v));
    grid.erase(v);
  }
  EXPECT_GT(bytes, grid.bytes());
  EXPECT_EQ(grid.freeBytes(), grid.blockCount() * sizeof(SlotGrid<8>::Block));
}

}  // namespace
}  // namespace edgevox::test
