// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/scan/voxel_scan.hpp"

#include <gtest/gtest.h>

namespace edgevox::test {
namespace {

using Eigen::Vector3f;

ScanVoxel voxel(const VoxelIndex& index, const Vector3f& centroid, uint32_t count, float time,
                bool edge) {
  ScanVoxel made;
  made.index = index;
  made.centroid = centroid;
  made.point_count = count;
  made.time_offset = time;
  made.edge = edge;
  return made;
}

VoxelScan threeVoxels() {
  VoxelScan scan;
  scan.stamp = 3.0;
  scan.number = 7;
  scan.voxel_size = 0.1;
  scan.voxels = {voxel({-1, 2, 4}, {-0.05F, 0.25F, 0.45F}, 1, 0.02F, false),
                 voxel({5, 5, 5}, {0.55F, 0.55F, 0.55F}, 2, 0.03F, false),
                 voxel({-2, 3, 5}, {-0.15F, 0.35F, 0.55F}, 3, 0.06F, true)};
  return scan;
}

TEST(VoxelScan, InMapVoxelsKeepsMeansOfThePoints) {
  const VoxelScan coarse = inMapVoxels(threeVoxels());
  EXPECT_EQ(3.0, coarse.stamp);
  EXPECT_EQ(7U, coarse.number);
  EXPECT_EQ(0.2, coarse.voxel_size);
  ASSERT_EQ(2U, coarse.voxels.size());
  const ScanVoxel& both = coarse.voxels[0];
  EXPECT_EQ((VoxelIndex{-1, 1, 2}), both.index);
  EXPECT_TRUE(both.centroid.isApprox(Vector3f(-0.125F, 0.325F, 0.525F), 1e-6F));
  EXPECT_NEAR(0.05F, both.time_offset, 1e-7F);
  EXPECT_EQ(4U, both.point_count);
  EXPECT_TRUE(both.edge);
  EXPECT_EQ((VoxelIndex{2, 2, 2}), coarse.voxels[1].index);
  EXPECT_EQ(2U, coarse.voxels[1].point_count);
}

TEST(VoxelScan, EdgeVoxelsAreTheEdgesAmongThose) {
  const VoxelScan edges = edgeVoxels(threeVoxels());
  ASSERT_EQ(1U, edges.voxels.size());
  EXPECT_EQ((VoxelIndex{-1, 1, 2}), edges.voxels[0].index);
  EXPECT_EQ(0.2, edges.voxel_size);
}

}  // namespace
}  // namespace edgevox::test
