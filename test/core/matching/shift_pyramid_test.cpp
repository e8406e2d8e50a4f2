// SPDX-License-Identifier: BSD-3-Clause
#include "core/matching/shift_pyramid.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/random.hpp"

namespace edgevox::test {
namespace {

constexpr int kHeight = 3;
constexpr int kReach = 40;  // of the voxels

int uniform(Random& random, int from, int to) {
  return static_cast<int>(std::floor(random.uniform(from, to)));
}

VoxelIndex randomVoxel(Random& random, int reach) {
  const int x = uniform(random, -reach, reach);
  const int y = uniform(random, -reach / 2, reach);
  return {x, y, uniform(random, 3, reach / 2)};
}

struct RandomVoxels {
  Random random{5};
  BitGrid<8> grid;
  std::vector<VoxelIndex> points;

  RandomVoxels() {
    for (int i = 0; i < 900; ++i) grid.set(randomVoxel(random, kReach));
    for (int i = 0; i < 50; ++i) points.push_back(randomVoxel(random, 2 * kReach));
  }

  /// Cells are half a voxel.
  int hits(const VoxelIndex& shift) const {
    return static_cast<int>(
        std::count_if(points.begin(), points.end(), [&](const VoxelIndex& point) {
          return grid.test(coarser({point.x + shift.x, point.y + shift.y, point.z + shift.z}, 1));
        }));
  }
};

TEST(ShiftPyramid, CountsHitsAtEveryShift) {
  RandomVoxels voxels;
  const ShiftPyramid pyramid(voxels.grid, kHeight);
  int most = 0;
  for (int i = 0; i < 2000; ++i) {
    const VoxelIndex shift = randomVoxel(voxels.random, 2 * kReach);
    const int hits = voxels.hits(shift);
    ASSERT_EQ(hits, pyramid.hits(0, voxels.points, shift, 0));
    most = std::max(most, hits);
  }
  EXPECT_GE(most, 3);
}

TEST(ShiftPyramid, BoundsTheHitsOfAllShiftsInACube) {
  RandomVoxels voxels;
  const ShiftPyramid pyramid(voxels.grid, kHeight);
  for (int height = 1; height <= kHeight; ++height) {
    const int size = 1 << height;
    int tight = 0;
    for (int i = 0; i < 60; ++i) {
      const VoxelIndex first = randomVoxel(voxels.random, 2 * kReach);
      const int bound = pyramid.hits(height, voxels.points, first, 0);
      int most = 0;
      for (int j = 0; j < size * size * size; ++j) {
        most = std::max(most, voxels.hits({first.x + j % size, first.y + j / size % size,
                                           first.z + j / size / size}));
      }
      ASSERT_GE(bound, most) << height;
      tight += bound == most ? 1 : 0;
    }
    EXPECT_GT(tight, 0) << height;
  }
}

TEST(ShiftPyramid, MayEndWhereTooFewCanHit) {
  RandomVoxels voxels;
  const ShiftPyramid pyramid(voxels.grid, kHeight);
  for (int i = 0; i < 500; ++i) {
    const VoxelIndex shift = randomVoxel(voxels.random, 2 * kReach);
    const int hits = pyramid.hits(2, voxels.points, shift, 0);
    for (const int least : {1, 5, 20, 50}) {
      const int counted = pyramid.hits(2, voxels.points, shift, least);
      if (hits >= least) {
        EXPECT_EQ(hits, counted);
      } else {
        EXPECT_LT(counted, least);
      }
    }
  }
}

TEST(ShiftPyramid, OfNothingHitsNothing) {
  const ShiftPyramid pyramid(BitGrid<8>{}, kHeight);
  EXPECT_TRUE(pyramid.box().empty());
  EXPECT_EQ(0, pyramid.hits(0, {{0, 0, 0}}, {0, 0, 0}, 0));
}

TEST(ShiftPyramid, TellsItsSizeBefore) {
  RandomVoxels voxels;
  const ShiftPyramid pyramid(voxels.grid, kHeight);
  EXPECT_EQ(pyramid.bytes(), ShiftPyramid::bytes(boxOf(voxels.grid), kHeight));
  EXPECT_GT(pyramid.bytes(), 1000U);
}

}  // namespace
}  // namespace edgevox::test
