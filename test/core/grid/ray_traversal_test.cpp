// SPDX-License-Identifier: BSD-3-Clause
#include "core/grid/ray_traversal.hpp"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>

#include "support/random.hpp"
#include "support/voxel_sets.hpp"

namespace edgevox::test {
namespace {

using Eigen::Vector3d;

std::vector<VoxelIndex> walked(const Vector3d& from, const Vector3d& to) {
  RayTraversal walk(from, to);
  std::vector<VoxelIndex> voxels{walk.at()};
  while (walk.advance()) voxels.push_back(walk.at());
  return voxels;
}

Vector3d randomPoint(Random& random) {
  const double x = random.uniform(-20, 20);
  const double y = random.uniform(-20, 20);
  return {x, y, random.uniform(-20, 20)};
}

TEST(RayTraversal, GoesFromFaceToFace) {
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const Vector3d from = randomPoint(random);
    const Vector3d to = randomPoint(random);
    const auto voxels = walked(from, to);
    EXPECT_EQ(voxelAt(from, 1.0), voxels.front());
    EXPECT_EQ(voxelAt(to, 1.0), voxels.back());
    for (size_t k = 1; k < voxels.size(); ++k) {
      const VoxelIndex& a = voxels[k - 1];
      const VoxelIndex& b = voxels[k];
      EXPECT_EQ(1, std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.z - b.z));
    }
  }
}

TEST(RayTraversal, PassesAllVoxelsOfTheLine) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const Vector3d from = randomPoint(random);
    const Vector3d to = randomPoint(random);
    const Voxels voxels = sorted(walked(from, to));
    for (int k = 0; k <= 1000; ++k) {
      const VoxelIndex v = voxelAt(from + 1e-3 * k * (to - from), 1.0);
      EXPECT_TRUE(std::binary_search(voxels.begin(), voxels.end(), v));
    }
  }
}

TEST(RayTraversal, AlongAnAxisAndOnTheSpot) {
  EXPECT_EQ((std::vector<VoxelIndex>{{0, 0, 0}, {-1, 0, 0}, {-2, 0, 0}}),
            walked({0.5, 0.5, 0.5}, {-1.5, 0.5, 0.5}));
  EXPECT_EQ((std::vector<VoxelIndex>{{1, 2, 3}, {1, 2, 4}, {1, 2, 5}}),
            walked({1, 2, 3}, {1, 2, 5}));
  EXPECT_EQ((std::vector<VoxelIndex>{{1, 2, 3}}), walked({1.1, 2.1, 3.1}, {1.1, 2.1, 3.1}));
}

TEST(ForEachOnLine, VisitsTheVoxelsOfTheGridInOrder) {
  Random random(5);
  BitGrid<8> grid;
  for (int i = 0; i < 20000; ++i) grid.set(voxelAt(randomPoint(random), 1.0));
  for (int i = 0; i < 100; ++i) {
    const Vector3d from = randomPoint(random);
    const Vector3d to = randomPoint(random);
    std::vector<VoxelIndex> expected;
    for (const VoxelIndex& v : walked(from, to)) {
      if (grid.test(v)) expected.push_back(v);
    }
    std::vector<VoxelIndex> visited;
    forEachOnRay(grid, from, to, [&](const VoxelIndex& v) { visited.push_back(v); });
    EXPECT_EQ(expected, visited);
  }
}

}  // namespace
}  // namespace edgevox::test
