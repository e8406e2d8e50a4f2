// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/ghosts.hpp"

#include <gtest/gtest.h>

#include "edgevox/map/map_builder.hpp"
#include "sim/parts.hpp"

namespace edgevox {
namespace {

using Eigen::Vector3d;

constexpr double kSize = 0.1;
constexpr double kEnd = 10.0;  // s

sim::Mover block() {
  sim::Mover mover;
  sim::addBox(mover.parts, {}, {-0.2, -0.2, 0.0}, {0.2, 0.2, 1.0}, 0.5);
  return mover;
}

/// A floor. On it a block that stands at x = 1 until 4 s, one that walks from x = 3 to x = 5 and
/// stops there, and one at x = 7 that stays.
SimulatedTruth floorWithBlocks() {
  sim::Solids floor;
  sim::addBox(floor, {}, {-10, -10, -1}, {10, 10, 0}, 0.5);
  sim::Mover taken = block();
  taken.line = {{1, 0, 0}};
  taken.end = 4.0;
  sim::Mover walking = block();
  walking.line = {{3, 0, 0}, {5, 0, 0}};
  walking.speed = 0.2;
  sim::Mover staying = block();
  staying.line = {{7, 0, 0}};
  const sim::Trajectory path({{{0, 0, 0}}, {{1, 0, 0}}}, sim::Gait{});
  return {sim::World(floor), {taken, walking, staying}, path, sim::makeSensor("16")};
}

/// Twice each of these centroids in its frame, as a map that counts what is hit twice.
MapBuilder mapOf(const std::vector<Vector3d>& centroids) {
  MapConfig config;
  config.confirm_within = 0;
  MapBuilder map(kSize, config, {}, 1);
  map.add(centroids, Vector3d(0, 0, 5));
  map.add(centroids, Vector3d(0, 0, 5));
  return map;
}

size_t ghostsOf(const MapBuilder& map, const SimulatedTruth& truth, const Pose& T_world_grid) {
  return GhostJudge(truth, 0.0, kEnd).count(centroidsOf(map, map.hitVoxels()), kSize, T_world_grid);
}

TEST(GhostJudge, TellsWhatIsNoLongerThere) {
  const SimulatedTruth truth = floorWithBlocks();
  const GhostJudge judge(truth, 0.0, kEnd);
  const auto isGhost = [&](double x, double y, double z) {
    return judge.isGhost({x, y, z}, kSize);
  };
  EXPECT_TRUE(isGhost(1.2, 0.0, 0.5));   // on the face of what was taken away
  EXPECT_TRUE(isGhost(1.29, 0.0, 0.5));  // within a voxel of it
  EXPECT_FALSE(isGhost(1.31, 0.0, 0.5));
  EXPECT_FALSE(isGhost(1.2, 0.0, 0.14));  // may be of the floor
  EXPECT_TRUE(isGhost(1.2, 0.0, 0.16));
  EXPECT_TRUE(isGhost(3.0, 0.2, 0.5));  // where one has walked
  EXPECT_TRUE(isGhost(4.64, 0.2, 0.5));
  EXPECT_FALSE(isGhost(4.66, 0.2, 0.5));  // next to where it stands in the end
  EXPECT_FALSE(isGhost(5.0, 0.2, 0.5));
  EXPECT_FALSE(isGhost(7.2, 0.0, 0.5));  // of what stays
  EXPECT_FALSE(isGhost(9.0, 0.0, 0.5));  // of nothing
}

TEST(GhostJudge, KnowsWhatWasThereMeanwhileOnly) {
  const SimulatedTruth truth = floorWithBlocks();
  EXPECT_FALSE(GhostJudge(truth, 5.0, kEnd).isGhost({1.2, 0.0, 0.5}, kSize));
  EXPECT_FALSE(GhostJudge(truth, 0.0, 3.0).isGhost({1.2, 0.0, 0.5}, kSize));
  EXPECT_FALSE(GhostJudge(truth, 5.0, kEnd).isGhost({3.0, 0.2, 0.5}, kSize));
  EXPECT_TRUE(GhostJudge(truth, 5.0, kEnd).isGhost({4.0, 0.2, 0.5}, kSize));
}

TEST(GhostJudge, CountsThoseOfAMap) {
  const SimulatedTruth truth = floorWithBlocks();
  std::vector<Vector3d> centroids = {{1.22, 0.05, 0.55}, {1.22, 0.15, 0.55},   // ghosts
                                     {3.05, 0.22, 0.55},                       // ghost
                                     {5.05, 0.22, 0.55}, {7.22, 0.05, 0.55},   // still there
                                     {1.05, 0.05, 0.02}, {9.05, 0.05, 0.02}};  // floor
  MapBuilder map = mapOf(centroids);
  EXPECT_EQ(ghostsOf(map, truth, Pose::Identity()), 3U);
  map.add({{1.22, -0.05, 0.55}}, Vector3d(0, 0, 5));  // hit once
  EXPECT_EQ(ghostsOf(map, truth, Pose::Identity()), 3U);
  const Pose T_world_grid(Eigen::Translation3d(0.33, -2.0, 0.1) *
                          Eigen::AngleAxisd(0.4, Vector3d::UnitZ()));
  for (Vector3d& centroid : centroids) centroid = T_world_grid.inverse() * centroid;
  EXPECT_EQ(ghostsOf(mapOf(centroids), truth, T_world_grid), 3U);
}

}  // namespace
}  // namespace edgevox
