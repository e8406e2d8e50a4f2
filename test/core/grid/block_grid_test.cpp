// SPDX-License-Identifier: BSD-3-Clause
// The block grids against the standard containers, under random operations.
#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "edgevox/grid/block_grid.hpp"
#include "support/random.hpp"
#include "support/voxel_sets.hpp"

namespace edgevox::test {
namespace {

template <typename Size>
class Grids : public ::testing::Test {};

template <int kSide>
struct Edge {
  static constexpr int kValue = kSide;
};
using Edges = ::testing::Types<Edge<8>, Edge<16>, Edge<32>>;
TYPED_TEST_SUITE(Grids, Edges, );

Voxels listOf(const std::set<VoxelIndex>& set) { return Voxels(set.begin(), set.end()); }

/// Mostly near the origin, on both sides of it; now and then anywhere in the range of a grid.
VoxelIndex someVoxel(Random& random) {
  if (random.chance(0.02)) return random.voxelIn(-kIndexLimit, kIndexLimit - 1);
  return random.voxelIn(-20, 20);
}

TEST(VoxelIndices, CoarserIsTheFloorOfTheQuotient) {
  EXPECT_EQ((VoxelIndex{-1, 0, 0}), coarser({-1, 1, 0}, 1));
  EXPECT_EQ((VoxelIndex{-1, -2, 1}), coarser({-8, -9, 8}, 3));
}

TEST(VoxelIndices, FloorOfNegativeNumbers) {
  EXPECT_EQ(-1, floorToInt(-0.25));
  EXPECT_EQ(-2, floorToInt(-2.0));
  EXPECT_EQ(0, floorToInt(0.99));
  EXPECT_EQ(3, floorToInt(3.0));
}

TEST(VoxelIndices, PackedIndexIsUniqueAtTheBordersOfTheRange) {
  std::set<uint64_t> packed;
  const std::vector<int32_t> extremes = {-kIndexLimit, -1, 0, kIndexLimit - 1};
  for (const int32_t z : extremes) {
    for (const int32_t y : extremes) {
      for (const int32_t x : extremes) {
        EXPECT_TRUE(inGridRange({x, y, z}));
        packed.insert(packedIndex({x, y, z}));
        EXPECT_EQ((VoxelIndex{x, y, z}), unpackedIndex(packedIndex({x, y, z})));
      }
    }
  }
  EXPECT_EQ(64U, packed.size());
  EXPECT_FALSE(inGridRange({kIndexLimit, 0, 0}));
  EXPECT_FALSE(inGridRange({0, 0, -kIndexLimit - 1}));
}

TEST(BlockTable, GivesSlotsInOrderOfInsertion) {
  Random random(1);
  BlockTable table;
  std::map<VoxelIndex, int32_t> expected;
  for (int i = 0; i < 20000; ++i) {
    const VoxelIndex block = someVoxel(random);
    const auto next = static_cast<int32_t>(expected.size());
    const auto entry = expected.emplace(block, next).first;
    ASSERT_EQ(entry->second, table.findOrInsert(block));
    const VoxelIndex other = someVoxel(random);
    const auto known = expected.find(other);
    ASSERT_EQ(known == expected.end() ? BlockTable::kNone : known->second, table.find(other));
  }
  ASSERT_EQ(expected.size(), table.size());
  for (const auto& [block, slot] : expected) {
    ASSERT_EQ(block, table.block(static_cast<size_t>(slot)));
  }
}

TEST(BlockTable, IsEmptyAfterClear) {
  Random random(2);
  BlockTable table;
  for (int i = 0; i < 500; ++i) table.findOrInsert(someVoxel(random));
  const VoxelIndex known = table.block(7);
  table.clear();
  EXPECT_EQ(0U, table.size());
  EXPECT_EQ(BlockTable::kNone, table.find(known));
  EXPECT_EQ(0, table.findOrInsert({5, 5, 5}));
}

/// Blocks whose hashes end alike in a table without a secret.
Voxels collidingBlocks(size_t count) {
  constexpr uint64_t kSameBits = (1 << 18) - 1;
  Voxels blocks;
  for (int32_t i = 0; blocks.size() < count; ++i) {
    const VoxelIndex block{i & 0xffff, i >> 16, 0};
    if ((voxelHash(block) & kSameBits) == 0) blocks.push_back(block);
  }
  return blocks;
}

TEST(BlockTable, ChosenBlocksDoNotCollide) {
  const Voxels blocks = collidingBlocks(2000);
  BlockTable table;
  size_t longest = 0;
  for (const VoxelIndex& block : blocks) table.findOrInsert(block);
  for (const VoxelIndex& block : blocks) longest = std::max(longest, table.probes(block));
  EXPECT_LT(longest, 64U);
}

TEST(BlockTable, FindsAnotherHashWhenSearchesGetLong) {
  constexpr uint64_t kKnownSeed = 0;
  const Voxels blocks = collidingBlocks(2000);
  BlockTable table(kKnownSeed);
  for (size_t i = 0; i < blocks.size(); ++i) {
    ASSERT_EQ(static_cast<int32_t>(i), table.findOrInsert(blocks[i]));
  }
  for (size_t i = 0; i < blocks.size(); ++i) {
    ASSERT_EQ(static_cast<int32_t>(i), table.find(blocks[i]));
    ASSERT_LE(table.probes(blocks[i]), 128U);
  }
}

TYPED_TEST(Grids, BitGridIsASet) {
  Random random(3);
  BitGrid<TypeParam::kValue> grid;
  std::set<VoxelIndex> expected;
  for (int i = 0; i < 60000; ++i) {
    const VoxelIndex v = someVoxel(random);
    if (random.chance(0.6)) {
      ASSERT_EQ(expected.insert(v).second, grid.set(v));
    } else {
      ASSERT_EQ(expected.erase(v) == 1, grid.reset(v));
    }
    const VoxelIndex other = someVoxel(random);
    ASSERT_EQ(expected.count(other) == 1, grid.test(other));
    if (random.chance(0.0001)) {
      grid.clear();
      expected.clear();
    }
  }
  EXPECT_EQ(expected.size(), grid.voxelCount());
  EXPECT_TRUE(sameVoxels(listOf(expected), voxelsOf(grid)));
}

TYPED_TEST(Grids, BitGridReusesBlocksEmpty) {
  BitGrid<TypeParam::kValue> grid;
  for (int32_t i = 0; i < 40; ++i) grid.set({7 * i, -3 * i, i});
  const size_t bytes = grid.bytes();
  grid.clear();
  EXPECT_EQ(0U, grid.voxelCount());
  EXPECT_EQ(0U, grid.blockCount());
  EXPECT_EQ(nullptr, grid.findBlock({0, 0, 0}));
  const size_t slot = grid.insertBlock({3, 4, 5});
  EXPECT_EQ(1U, grid.blockCount());
  for (const auto row : grid.block(slot)) EXPECT_EQ(0U, row);
  EXPECT_EQ(bytes, grid.bytes());
}

TYPED_TEST(Grids, BitGridVisitsTheVoxelsOfABlock) {
  using Grid = BitGrid<TypeParam::kValue>;
  Random random(4);
  Grid grid;
  for (int i = 0; i < 3000; ++i) grid.set(random.voxelIn(-40, 40));
  for (size_t slot = 0; slot < grid.blockCount(); ++slot) {
    const VoxelIndex& block = grid.blockIndex(slot);
    ASSERT_EQ(&grid.block(slot), grid.findBlock(block));
    Grid::forEachInBlock(block, grid.block(slot), [&](const VoxelIndex& v) {
      ASSERT_TRUE(grid.test(v));
      ASSERT_EQ(block, Grid::Layout::block(v));
    });
  }
}

TYPED_TEST(Grids, SlotGridIsAMap) {
  Random random(5);
  SlotGrid<TypeParam::kValue> grid;
  std::map<VoxelIndex, uint32_t> expected;
  for (uint32_t next = 0; next < 60000; ++next) {
    const VoxelIndex v = someVoxel(random);
    if (random.chance(0.6)) {
      ASSERT_EQ(expected.emplace(v, next).first->second, grid.insert(v, next));
    } else {
      expected.erase(v);
      grid.erase(v);
    }
    const VoxelIndex other = someVoxel(random);
    const auto known = expected.find(other);
    ASSERT_EQ(known == expected.end() ? grid.kNone : known->second, grid.find(other));
    if (random.chance(0.0001)) {
      grid.clear();
      expected.clear();
    }
  }
}

TYPED_TEST(Grids, SlotGridVisitsTheVoxelsOfABlockInTheirOrder) {
  using Grid = SlotGrid<TypeParam::kValue>;
  using Layout = typename Grid::Layout;
  Random random(9);
  Grid grid;
  std::map<VoxelIndex, std::map<int, uint32_t>> expected;  // slots by block and cell
  for (uint32_t i = 0; i < 3000; ++i) {
    const VoxelIndex v = random.voxelIn(-40, 40);
    expected[Layout::block(v)].emplace(Layout::cell(v), i);
    grid.insert(v, i);
  }
  ASSERT_EQ(expected.size(), grid.blockCount());
  for (size_t block = 0; block < grid.blockCount(); ++block) {
    std::vector<uint32_t> slots;
    for (const auto& [cell, slot] : expected[grid.blockIndex(block)]) slots.push_back(slot);
    std::vector<uint32_t> visited;
    grid.forEachInBlock(block, [&](uint32_t slot) { visited.push_back(slot); });
    ASSERT_EQ(slots, visited);
  }
}

TYPED_TEST(Grids, SlotGridKeepsALoneVoxelSmall) {
  SlotGrid<TypeParam::kValue> grid;
  constexpr int kCount = 1000;
  for (int i = 0; i < kCount; ++i) grid.insert({200 * i, 0, 0}, static_cast<uint32_t>(i));
  constexpr size_t kBitsOfABlock = BlockLayout<TypeParam::kValue>::kVoxels / 8;
  EXPECT_LT(grid.bytes(), kCount * (kBitsOfABlock + kBitsOfABlock / 4 + 80));
}

TYPED_TEST(Grids, SlotGridFindsWithinABlock) {
  using Grid = SlotGrid<TypeParam::kValue>;
  Random random(6);
  Grid grid;
  for (uint32_t i = 0; i < 2000; ++i) grid.insert(random.voxelIn(-30, 30), i);
  for (int i = 0; i < 5000; ++i) {
    const VoxelIndex v = random.voxelIn(-35, 35);
    const int32_t block = grid.findBlock(Grid::Layout::block(v));
    const uint32_t in_block = block == BlockTable::kNone
                                  ? Grid::kNone
                                  : Grid::slotIn(grid.block(static_cast<size_t>(block)), v);
    ASSERT_EQ(grid.find(v), in_block);
  }
}

}  // namespace
}  // namespace edgevox::test
