// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/mapping/localizer.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "edgevox/mapping/mapper.hpp"
#include "support/mapped_world.hpp"
#include "support/sweeps.hpp"

namespace edgevox::test {
namespace {

using Eigen::Vector3d;

struct TwinRooms {
  Config config;
  sim::World world = twinRooms();
  MatchMap map = mapFrom(world, posesInTwinRooms(), config);
  uint32_t scans = 100;

  VoxelScan seenFrom(const Pose& pose) { return scanFrom(world, pose, config, ++scans); }
};

void expectAt(const Pose& expected, const ScanResult& result) {
  ASSERT_TRUE(result.located()) << toString(result.status) << " at "
                                << expected.translation().transpose();
  const PoseDifference off = differenceOf(expected, result.T_map_sensor);
  EXPECT_LT(off.metres, 0.05) << expected.translation().transpose();
  EXPECT_LT(off.degrees, 0.5);
}

TEST(Localizer, StartsAnywhere) {
  TwinRooms rooms;
  Localizer localizer(rooms.config, rooms.map);
  EXPECT_TRUE(localizer.isLooking());
  for (int i = 0; i < 10; ++i) {
    const Pose truth = poseOf({20.0 + 0.05 * i, 1.0, 0.0}, 0.3 + 0.01 * i);
    expectAt(truth, localizer.process(rooms.seenFrom(truth)));
  }
  EXPECT_FALSE(localizer.isLooking());
}

TEST(Localizer, StartsWhereItIsTold) {
  for (const double room : {0.0, 12.0}) {
    TwinRooms rooms;
    Localizer localizer(rooms.config, rooms.map);
    const Pose truth = poseOf({room + 3.4, 5.2, 0.0}, 0.8);
    localizer.lookNear(poseOf({room + 4.6, 4.3, 0.1}, 0.3));
    expectAt(truth, localizer.process(rooms.seenFrom(truth)));
  }
}

TEST(Localizer, LooksEverywhereIfItIsToldWrong) {
  TwinRooms rooms;
  Localizer localizer(rooms.config, rooms.map);
  localizer.lookNear(poseOf({4.0, 5.0, 0.0}, 0.0));
  const Pose truth = poseOf({20.0, 1.0, 0.0}, 0.3);
  expectAt(truth, localizer.process(rooms.seenFrom(truth)));
}

TEST(Localizer, FollowsPosesThatLookAlikeUntilOneIsLeft) {
  for (const double room : {0.0, 12.0}) {
    TwinRooms rooms;
    Localizer localizer(rooms.config, rooms.map);
    bool located = false;
    Pose truth = poseOf({room + 3.4, 5.2, 0.0}, 0.8);
    for (int i = 0; i < 60; ++i) {  // to the door, through it, along the hall
      const Vector3d target = i < 12   ? Vector3d(room + 4.0, 4.0, 0.0)
                              : i < 40 ? Vector3d(room + 4.0, 1.0, 0.0)
                                       : Vector3d(room + 7.0, 1.0, 0.0);
      const Vector3d way = target - truth.translation();
      truth.translation() += way.normalized() * std::min(0.1, way.norm());
      const ScanResult result = localizer.process(rooms.seenFrom(truth));
      if (i == 0) EXPECT_EQ(ScanStatus::kAmbiguous, result.status);
      if (result.located()) expectAt(truth, result);
      if (located) EXPECT_TRUE(result.located()) << i;
      located = located || result.located();
    }
    EXPECT_TRUE(located);
  }
}

TEST(Localizer, FindsASensorThatWasCarriedAway) {
  TwinRooms rooms;
  rooms.config.localizer.search_after = 3;
  Localizer localizer(rooms.config, rooms.map);
  const Pose before = poseOf({20.0, 1.0, 0.0}, 0.3);
  const Pose after = poseOf({-1.0, 1.0, 0.0}, 2.0);
  for (int i = 0; i < 5; ++i) expectAt(before, localizer.process(rooms.seenFrom(before)));
  std::vector<ScanResult> results;
  for (int i = 0; i < 6; ++i) results.push_back(localizer.process(rooms.seenFrom(after)));
  EXPECT_FALSE(results[0].located());
  expectAt(after, results[4]);
  expectAt(after, results[5]);
}

TEST(Localizer, ReportsWhatDoesNotFit) {
  TwinRooms rooms;
  Localizer localizer(rooms.config, rooms.map);
  const Pose truth = poseOf({20.0, 1.0, 0.0}, 0.3);
  EXPECT_GT(localizer.process(rooms.seenFrom(truth)).hit_share, 0.98);
  sim::Solids solids = rooms.world.solids();
  sim::addBox(solids, {0, 0, -1.4, 0}, {22.0, 0.2, 0.0}, {22.5, 1.8, 2.5}, 0.5);
  const VoxelScan scan = scanFrom(sim::World(solids), truth, rooms.config, 200);
  const ScanResult result = localizer.process(scan);
  expectAt(truth, result);
  EXPECT_LT(result.hit_share, 0.94);
}

TEST(Mapper, LooksForALostSensorInItsMapIfAsked) {
  TwinRooms rooms;
  rooms.config.mapper.search_after = 3;
  Mapper mapper(rooms.config);
  const Pose start = poseOf({4.0, 5.0, 0.0}, 0.0);
  Pose pose = start;
  const auto walk = [&](const Vector3d& to) {
    for (Vector3d way = to - pose.translation(); way.norm() > 0.01; way = to - pose.translation()) {
      pose.translation() += way.normalized() * std::min(0.25, way.norm());
      ASSERT_TRUE(mapper.process(rooms.seenFrom(pose)).located()) << pose.translation().x();
    }
  };
  ASSERT_TRUE(mapper.process(rooms.seenFrom(start)).located());
  walk({4.0, 1.0, 0.0});
  walk({27.0, 1.0, 0.0});
  const Pose carried = poseOf({3.4, 5.2, 0.0}, 1.0);
  for (int i = 0; i < 6; ++i) {
    const ScanResult result = mapper.process(rooms.seenFrom(carried));
    ASSERT_EQ(i >= 2, result.located()) << i;
    if (!result.located()) continue;
    EXPECT_LT(differenceOf(start * result.T_map_sensor, carried).metres, 0.15);
  }
}

}  // namespace
}  // namespace edgevox::test
