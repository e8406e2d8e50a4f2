// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/octree_leaves.hpp"

#include <gtest/gtest.h>

namespace edgevox {
namespace {

std::vector<VoxelIndex> cube(int32_t first, int32_t edge) {
  std::vector<VoxelIndex> leaves;
  for (int32_t i = 0; i < edge * edge * edge; ++i) {
    leaves.push_back({first + i % edge, first + i / edge % edge, first + i / edge / edge});
  }
  return leaves;
}

TEST(OctreeLeaves, CountsEachLeafOnce) {
  std::vector<Eigen::Vector3f> points;
  for (const VoxelIndex& v : cube(0, 4)) points.push_back(voxelCentre(v, 0.5).cast<float>());
  EXPECT_EQ(octreeLeaves(points, 0.5).size(), 64U);
  points.insert(points.end(), points.begin(), points.begin() + 32);
  EXPECT_EQ(octreeLeaves(points, 0.5).size(), 64U);
  EXPECT_EQ(octreeLeaves(points, 8.0).size(), 1U);
  EXPECT_EQ(octreeLeaves({}, 0.5).size(), 0U);
}

TEST(MergedLeafCount, MergesEightOfOneParentOnly) {
  EXPECT_EQ(mergedLeafCount({}), 0U);
  EXPECT_EQ(mergedLeafCount(cube(2, 2)), 1U);
  EXPECT_EQ(mergedLeafCount(cube(1, 2)), 8U);  // of eight parents
  auto seven = cube(2, 2);
  seven.pop_back();
  EXPECT_EQ(mergedLeafCount(seven), 7U);
  auto nine = cube(2, 2);
  nine.push_back({9, 9, 9});
  EXPECT_EQ(mergedLeafCount(nine), 2U);
}

TEST(MergedLeafCount, MergesAtAllLevels) {
  EXPECT_EQ(mergedLeafCount(cube(8, 8)), 1U);
  EXPECT_EQ(mergedLeafCount(cube(2, 4)), 8U);  // eight full parents, each of another one
}

}  // namespace
}  // namespace edgevox
