// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/labelled_voxels.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace edgevox {
namespace {

constexpr double kSize = 0.5;

LabelledVoxels setOf(const std::vector<VoxelIndex>& edges, const std::vector<VoxelIndex>& others) {
  LabelledVoxels set;
  set.voxel_size = kSize;
  for (const VoxelIndex& v : edges) set.voxels.push_back({v, voxelCentre(v, kSize), 0.0, true});
  for (const VoxelIndex& v : others) set.voxels.push_back({v, voxelCentre(v, kSize), 0.0, false});
  set.edges = edges.size();
  return set;
}

TEST(Agreement, CountsNeighboursAndOnlyTheOverlap) {
  const LabelledVoxels to = setOf({{0, 0, 0}, {20, 0, 0}}, {{3, 0, 0}, {10, 0, 0}, {21, 0, 0}});
  const LabelledVoxels from = setOf(
      {{1, -1, 1}, {2, 0, 0}, {4, 1, 0}, {50, 0, 0}},  // again; by a plain one; the same; nowhere
      {{0, 0, 0}, {22, 0, 0}, {-2, 0, 0}});            // again; by a plain one; nowhere
  const Agreement sum = agreement(from, cellsOf(to, Pose::Identity()), Pose::Identity());
  EXPECT_EQ(sum.edges, 3U);
  EXPECT_EQ(sum.edges_again, 1U);
  EXPECT_EQ(sum.others, 2U);
  EXPECT_EQ(sum.others_again, 1U);
  EXPECT_DOUBLE_EQ(sum.edgeShare(), 1.0 / 3.0);
  EXPECT_TRUE(std::isnan(Agreement().edgeShare()));
}

TEST(Agreement, ComparesInTheFrameOfTheOther) {
  Pose T_map_grid = Pose::Identity();
  T_map_grid.translate(Eigen::Vector3d(0.25, 0.1, 0.0));
  T_map_grid.rotate(Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitZ()));
  const LabelledVoxels set = setOf({{7, 2, 3}}, {{-8, 5, 1}});
  const Cells cells = cellsOf(set, T_map_grid);
  const Eigen::Vector3d moved = T_map_grid.inverse() * voxelCentre({7, 2, 3}, kSize);
  EXPECT_TRUE(cells.edges.test(voxelAt(moved, 1.0 / kSize)));
  EXPECT_FALSE(cells.edges.test({7, 2, 3}));
  const Agreement same = agreement(set, cells, T_map_grid);
  EXPECT_EQ(same.edges_again, 1U);
  EXPECT_EQ(same.others, 1U);
  EXPECT_EQ(same.others_again, 0U);
  EXPECT_EQ(agreement(set, cells, Pose::Identity()).edges, 0U);
}

TEST(Recall, IsOfTheMapsEdgesThatTheScanOccupies) {
  BitGrid<16> map_edges;
  for (const VoxelIndex& v : {VoxelIndex{0, 0, 0}, {1, 0, 0}, {5, 0, 0}, {30, 0, 0}}) {
    map_edges.set(v);
  }
  const Recall recall = recallOf(setOf({{-1, 0, 0}}, {{2, 0, 0}, {4, 1, 1}}), map_edges);
  EXPECT_EQ(recall.occupied, 3U);  // not {30, 0, 0}
  EXPECT_EQ(recall.labelled, 1U);  // only {0, 0, 0}
}

ScanVoxel scanVoxel(const VoxelIndex& index, float time_offset, uint32_t points, bool edge) {
  ScanVoxel voxel;
  voxel.index = index;
  voxel.time_offset = time_offset;
  voxel.point_count = points;
  voxel.edge = edge;
  return voxel;
}

TEST(LabelledVoxels, JoinsTheHalvesAndMovesThemWithTheirTimes) {
  Recording recording;
  recording.scans.resize(1);
  recording.scans[0].T_map_sensor.translation() = Eigen::Vector3d(100, 0, 0);
  recording.scans[0].after.linear = Eigen::Vector3d(0, 10, 0);
  recording.scans[0].before.linear = Eigen::Vector3d(0, 0, 30);
  VoxelScan scan;
  scan.voxel_size = 0.5 * kSize;
  scan.voxels = {scanVoxel({2, 4, 6}, 0.1F, 1, true), scanVoxel({3, 5, 7}, 0.4F, 3, true),
                 scanVoxel({-1, -1, -1}, -0.1F, 2, false)};
  const LabelledVoxels set = labelledVoxels(recording, 0, scan);
  ASSERT_EQ(set.occupied(), 2U);
  EXPECT_EQ(set.edges, 1U);
  EXPECT_EQ(set.voxel_size, kSize);
  EXPECT_EQ(set.voxels[0].index, (VoxelIndex{1, 2, 3}));
  EXPECT_NEAR(set.voxels[0].time_offset, 0.325, 1e-6);
  const Eigen::Vector3d ahead = voxelCentre({1, 2, 3}, kSize) + Eigen::Vector3d(100, 3.25, 0);
  EXPECT_LT((set.voxels[0].centre - ahead).norm(), 1e-5);
  const Eigen::Vector3d behind = voxelCentre({-1, -1, -1}, kSize) + Eigen::Vector3d(100, 0, -3);
  EXPECT_LT((set.voxels[1].centre - behind).norm(), 1e-5);
}

TEST(LabelledVoxels, OfTheMapAreItsHitVoxelsAndEdges) {
  // The outside of a cube, hit twice.
  std::vector<Eigen::Vector3d> centroids;
  for (int x = 0; x < 20; ++x) {
    for (int y = 0; y < 20; ++y) {
      for (int z = 0; z < 20; ++z) {
        const bool outside = x % 19 == 0 || y % 19 == 0 || z % 19 == 0;
        if (outside) centroids.push_back(voxelCentre({x, y, z}, kSize));
      }
    }
  }
  MapBuilder map(kSize, MapConfig(), EdgeConfig(), 1);
  for (int scan = 0; scan < 2; ++scan) map.add(centroids, {50, 50, 50});
  map.label();
  const LabelledVoxels set = labelledVoxels(map, Pose::Identity());
  EXPECT_EQ(set.occupied(), centroids.size());
  EXPECT_GT(set.edges, 12U * 18U);
  EXPECT_LT(set.edges, set.occupied() / 2);
  size_t edges = 0;
  for (const LabelledVoxel& voxel : set.voxels) edges += voxel.edge ? 1 : 0;
  EXPECT_EQ(set.edges, edges);
  const Agreement same = agreement(set, cellsOf(set, Pose::Identity()), Pose::Identity());
  EXPECT_EQ(same.edgeShare(), 1.0);
  EXPECT_LT(same.otherShare(), 0.5);
  const Pose T_map_grid(Eigen::Translation3d(0, 0, 9) *
                        Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitZ()));
  const LabelledVoxels turned = labelledVoxels(map, T_map_grid);
  EXPECT_EQ(turned.edges, set.edges);
  const LabelledVoxel& voxel = turned.voxels[5];
  const Eigen::Vector3d centre = voxelCentre(voxel.index, kSize);
  EXPECT_LT((voxel.centre - Eigen::Vector3d(-centre.y(), centre.x(), centre.z() + 9)).norm(), 1e-9);
}

}  // namespace
}  // namespace edgevox
