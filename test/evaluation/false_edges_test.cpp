// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/false_edges.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "sim/parts.hpp"

namespace edgevox {
namespace {

constexpr double kSize = 0.1;
constexpr int32_t kColumn = 30;  // of the voxels that hold the wall's face at x = 3.05

/// A wall before the sensor and, in front of its part with y > 1, a board.
sim::World wallAndBoard() {
  sim::Solids solids;
  sim::addTurnedBox(solids, {3.55, 0, 0}, {1, 10, 10}, Eigen::Quaterniond::Identity(), 0.5);
  sim::addTurnedBox(solids, {1.0, 1.0, 0}, {0.1, 1.0, 2}, Eigen::Quaterniond::Identity(), 0.5);
  return sim::World(solids);
}

/// The voxels of the wall around (y, z) that `hit` says are occupied.
BitGrid<16> wallVoxels(const std::function<bool(int32_t, int32_t)>& hit) {
  BitGrid<16> occupied;
  for (int32_t y = -30; y < 30; ++y) {
    for (int32_t z = -30; z < 30; ++z) {
      if (hit(y, z)) occupied.set({kColumn, y, z});
    }
  }
  return occupied;
}

class FalseEdgesTest : public ::testing::Test {
 protected:
  FalseEdgeCause causeAt(int32_t y, int32_t z, const std::function<bool(int32_t, int32_t)>& hit) {
    const FalseEdgeJudge judge(world_, sensor_, poses_);
    return judge.causeOf({kColumn, y, z}, wallVoxels(hit), kSize, T_world_grid_);
  }

  sim::World world_ = wallAndBoard();
  sim::Sensor sensor_ = sim::makeSensor("16");  // +-15 degrees: the wall to z = +-0.82 m
  std::vector<Pose> poses_ = {Pose::Identity()};
  Pose T_world_grid_ = Pose::Identity();
};

bool all(int32_t, int32_t) { return true; }
bool inView(int32_t, int32_t z) { return z >= -8 && z < 8; }
bool inLight(int32_t y, int32_t) { return y < 15; }  // the board's shadow begins at y = 1.45 m
bool onLines(int32_t, int32_t z) { return z % 3 == 0; }

TEST_F(FalseEdgesTest, NothingIsMissing) {
  EXPECT_EQ(causeAt(-10, 0, all), FalseEdgeCause::kNothingGone);
}

TEST_F(FalseEdgesTest, RimOfTheView) {
  EXPECT_EQ(causeAt(-10, 7, inView), FalseEdgeCause::kRimOfView);
  EXPECT_EQ(causeAt(-10, -8, inView), FalseEdgeCause::kRimOfView);
  EXPECT_EQ(causeAt(-10, 0, inView), FalseEdgeCause::kNothingGone);
}

TEST_F(FalseEdgesTest, OutOfRangeIsOutOfView) {
  sensor_.max_range = 3.06;
  EXPECT_EQ(causeAt(-10, 0, [](int32_t y, int32_t) { return y > -11; }),
            FalseEdgeCause::kRimOfView);
}

TEST_F(FalseEdgesTest, RangeJump) {
  EXPECT_EQ(causeAt(14, 0, inLight), FalseEdgeCause::kRangeJump);
  // Another pose sees behind the board: then the surface was there to be hit.
  poses_.push_back(Pose(Eigen::Translation3d(0, 4, 0)));
  EXPECT_EQ(causeAt(14, 0, inLight), FalseEdgeCause::kScanLineGap);
}

TEST_F(FalseEdgesTest, GapBetweenScanLines) {
  EXPECT_EQ(causeAt(-10, 0, onLines), FalseEdgeCause::kScanLineGap);
}

TEST_F(FalseEdgesTest, TheMajorityDecides) {
  const auto rim_and_hole = [](int32_t y, int32_t z) {
    return inView(y, z) && !(y == -9 && z == 5);
  };
  EXPECT_EQ(causeAt(-10, 7, rim_and_hole), FalseEdgeCause::kRimOfView);
  EXPECT_EQ(causeAt(-10, 4, rim_and_hole), FalseEdgeCause::kScanLineGap);
}

TEST_F(FalseEdgesTest, WhatHasMovedIsTheCauseAwayFromTheWall) {
  sim::Solids block;
  sim::addTurnedBox(block, {2.6, -1.0, 0}, {0.6, 0.2, 1}, Eigen::Quaterniond::Identity(), 0.5);
  const FalseEdgeJudge judge(world_, sensor_, poses_, sim::World(block));
  const auto causeIn = [&](const VoxelIndex& edge) {
    return judge.causeOf(edge, wallVoxels(all), kSize, T_world_grid_);
  };
  EXPECT_EQ(causeIn({25, -10, 0}), FalseEdgeCause::kMovedObject);  // inside the block
  EXPECT_EQ(causeIn({25, -13, 0}), FalseEdgeCause::kMovedObject);  // 1.5 voxels beside it
  EXPECT_EQ(causeIn({25, -15, 0}), FalseEdgeCause::kNothingGone);
  EXPECT_EQ(causeIn({29, -10, 0}), FalseEdgeCause::kNothingGone);  // as near to the wall
  T_world_grid_.translation() = Eigen::Vector3d(0, 2, 0);
  EXPECT_EQ(causeIn({25, -30, 0}), FalseEdgeCause::kMovedObject);
  EXPECT_EQ(causeIn({25, -10, 0}), FalseEdgeCause::kNothingGone);
}

TEST_F(FalseEdgesTest, AMovedGridIsUnderstood) {
  T_world_grid_.translation() = Eigen::Vector3d(0, 2, 0);
  poses_[0].translation() = Eigen::Vector3d(0, 2, 0);
  EXPECT_EQ(causeAt(-15, 7, inView), FalseEdgeCause::kRimOfView);
}

TEST_F(FalseEdgesTest, TheSurfaceMayLieBetweenTwoLayersOfVoxels) {
  T_world_grid_.translation() = Eigen::Vector3d(0.049, 0, 0);  // the face at 30.01 voxels
  EXPECT_EQ(causeAt(-10, 0, all), FalseEdgeCause::kNothingGone);
  T_world_grid_.translation() = Eigen::Vector3d(-0.049, 0, 0);  // at 30.99
  EXPECT_EQ(causeAt(-10, 0, all), FalseEdgeCause::kNothingGone);
}

}  // namespace
}  // namespace edgevox
