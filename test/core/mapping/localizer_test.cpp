// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/mapping/localizer.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "edgevox/io/map_file.hpp"
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

TEST(Localizer, TellsWhereTheSensorMayBe) {
  TwinRooms rooms;
  Localizer localizer(rooms.config, rooms.map);
  EXPECT_TRUE(localizer.candidates().empty());
  const Pose truth = poseOf({3.4, 5.2, 0.0}, 0.8);
  EXPECT_EQ(ScanStatus::kAmbiguous, localizer.process(rooms.seenFrom(truth)).status);
  std::vector<Pose> candidates = localizer.candidates();
  ASSERT_EQ(2U, candidates.size());
  std::sort(candidates.begin(), candidates.end(),
            [](const Pose& a, const Pose& b) { return a.translation().x() < b.translation().x(); });
  for (size_t i = 0; i < 2; ++i) {
    const Pose twin = poseOf({3.4 + 12.0 * static_cast<double>(i), 5.2, 0.0}, 0.8);
    EXPECT_LT(differenceOf(twin, candidates[i]).metres, 0.05) << i;
  }
  localizer.lookNear(truth);
  EXPECT_TRUE(localizer.process(rooms.seenFrom(truth)).located());
  EXPECT_TRUE(localizer.candidates().empty());
}

TEST(Localizer, SaysWhatIsWrongWithAScanWhileItLooks) {
  TwinRooms rooms;
  Localizer localizer(rooms.config, rooms.map);
  VoxelScan scan = rooms.seenFrom(poseOf({20.0, 1.0, 0.0}, 0.3));
  scan.voxels.resize(3);
  EXPECT_EQ(ScanStatus::kTooFew, localizer.process(scan).status);
  scan = rooms.seenFrom(poseOf({20.0, 1.0, 0.0}, 0.3));
  scan.too_large = "more than it may have";
  EXPECT_EQ(ScanStatus::kTooLarge, localizer.process(scan).status);
  for (size_t i = 0; i < scan.voxels.size(); ++i) {  // no place looks like this
    scan.voxels[i].centroid =
        Eigen::Vector3f(0.3F * static_cast<float>(i % 30), 0.0F, 0.2F * static_cast<float>(i / 30));
  }
  scan.too_large.clear();
  const ScanResult result = localizer.process(scan);
  EXPECT_EQ(ScanStatus::kLost, result.status);
  EXPECT_EQ(Refusal::kNotFound, result.refusal);
}

TEST(Localizer, BeginsAnewWhereTheClockJumpsBackWhileItCompares) {
  TwinRooms rooms;
  Localizer localizer(rooms.config, rooms.map);
  const Pose in_room = poseOf({3.4, 5.2, 0.0}, 0.8);
  const Pose in_hall = poseOf({20.0, 1.0, 0.0}, 0.3);
  for (uint32_t i = 1000; i < 1003; ++i) {
    const VoxelScan scan = scanFrom(rooms.world, in_room, rooms.config, i);
    EXPECT_EQ(ScanStatus::kAmbiguous, localizer.process(scan).status);
  }
  const VoxelScan late = scanFrom(rooms.world, in_hall, rooms.config, 10);  // or is the clock back?
  EXPECT_EQ(ScanStatus::kStale, localizer.process(late).status);
  const ScanResult result = localizer.process(scanFrom(rooms.world, in_hall, rooms.config, 11));
  expectAt(in_hall, result);
  EXPECT_TRUE(result.clock_jumped);
}

TEST(Localizer, SaysThatItsSearchWasCancelled) {
  TwinRooms rooms;
  Localizer localizer(rooms.config, rooms.map);
  const std::atomic<bool> cancel{true};
  localizer.setControl({2, &cancel});
  const Pose truth = poseOf({20.0, 1.0, 0.0}, 0.3);
  EXPECT_EQ(Refusal::kCancelled, localizer.process(rooms.seenFrom(truth)).refusal);
  EXPECT_TRUE(localizer.isLooking());
  localizer.setControl({2});
  expectAt(truth, localizer.process(rooms.seenFrom(truth)));
}

/// Maps what a sensor sees on its way from the middle of the first room.
class RoomsBeingMapped {
 public:
  explicit RoomsBeingMapped(const Config& config) : mapper_(config) {
    rooms_.config = config;
    EXPECT_TRUE(mapper_.process(seenFrom(start_)).located());
  }

  void walkTo(const Vector3d& to) {
    for (Vector3d way = to - pose_.translation(); way.norm() > 0.01;
         way = to - pose_.translation()) {
      pose_.translation() += way.normalized() * std::min(0.25, way.norm());
      ASSERT_TRUE(mapper_.process(seenFrom(pose_)).located()) << to.transpose();
    }
  }
  Mapper& mapper() { return mapper_; }
  VoxelScan seenFrom(const Pose& pose) { return rooms_.seenFrom(pose); }
  Pose inMap(const Pose& pose) const { return start_.inverse() * pose; }

 private:
  TwinRooms rooms_;
  const Pose start_ = poseOf({4.0, 5.0, 0.0}, 0.0);
  Pose pose_ = start_;
  Mapper mapper_;
};

void expectMapped(const Pose& expected, const ScanResult& result) {
  ASSERT_TRUE(result.located()) << toString(result.status);
  EXPECT_LT(differenceOf(expected, result.T_map_sensor).metres, 0.15);
}

TEST(Mapper, LooksForALostSensorInItsMapIfAsked) {
  Config config;
  config.mapper.search_after = 3;
  RoomsBeingMapped rooms(config);
  rooms.walkTo({4.0, 1.0, 0.0});
  rooms.walkTo({27.0, 1.0, 0.0});
  const Pose carried = poseOf({3.4, 5.2, 0.0}, 1.0);
  for (int i = 0; i < 6; ++i) {
    const ScanResult result = rooms.mapper().process(rooms.seenFrom(carried));
    ASSERT_EQ(i >= 2, result.located()) << i;
    if (result.located()) expectMapped(rooms.inMap(carried), result);
  }
}

/// A mapper that has read the map of both rooms and the hall, at whose end the sensor was last.
class GivenMap : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    rooms_ = std::make_unique<RoomsBeingMapped>(Config{});
    rooms_->walkTo({4.0, 1.0, 0.0});
    rooms_->walkTo({16.0, 1.0, 0.0});
    rooms_->walkTo({16.0, 5.0, 0.0});
    rooms_->walkTo({16.0, 1.0, 0.0});
    rooms_->walkTo({27.0, 1.0, 0.0});
  }
  static void TearDownTestSuite() { rooms_.reset(); }

  GivenMap() {
    const Config config;
    MapFile(mapFileBytes(MapContent::kFull, rooms_->mapper(), config, "map"), "the rooms")
        .restore(mapper_);
  }

  static std::unique_ptr<RoomsBeingMapped> rooms_;
  Mapper mapper_{Config{}};
  const Pose in_first_ = poseOf({3.4, 5.2, 0.0}, 0.8);
  const Pose in_hall_ = poseOf({20.0, 1.0, 0.0}, 0.3);
};
std::unique_ptr<RoomsBeingMapped> GivenMap::rooms_;

TEST_F(GivenMap, GoesOnAnywhere) {
  const uint32_t scans = mapper_.map().scans();
  const VoxelScan scan = scanFrom(twinRooms(), in_hall_, Config{}, 5000);  // after minutes
  expectMapped(rooms_->inMap(in_hall_), mapper_.process(scan));
  EXPECT_EQ(scans + 1, mapper_.map().scans());
}

TEST_F(GivenMap, IsSearchedUntilTheSensorIsFound) {
  const sim::World elsewhere = furnishedRoom();
  for (uint32_t i = 0; i < 4; ++i) {
    const VoxelScan scan = scanFrom(elsewhere, Pose::Identity(), Config{}, 500 + i);
    EXPECT_FALSE(mapper_.process(scan).located()) << i;
  }
  for (uint32_t i = 0; i < 2; ++i) {
    const VoxelScan scan = scanFrom(twinRooms(), in_hall_, Config{}, 510 + i);
    expectMapped(rooms_->inMap(in_hall_), mapper_.process(scan));
  }
}

TEST_F(GivenMap, OfPlacesThatLookAlikeOneIsLeftWhenTheSensorMovesOn) {
  Pose truth = in_first_;
  bool located = false;
  for (uint32_t i = 0; i < 60; ++i) {  // through the door and along the hall
    const Vector3d target = i < 12   ? Vector3d(4.0, 4.0, 0.0)
                            : i < 40 ? Vector3d(4.0, 1.0, 0.0)
                                     : Vector3d(7.0, 1.0, 0.0);
    const Vector3d way = target - truth.translation();
    truth.translation() += way.normalized() * std::min(0.1, way.norm());
    const ScanResult result = mapper_.process(scanFrom(twinRooms(), truth, Config{}, 1000 + i));
    if (i == 0) EXPECT_EQ(ScanStatus::kAmbiguous, result.status);
    if (result.located()) expectMapped(rooms_->inMap(truth), result);
    located = located || result.located();
  }
  EXPECT_TRUE(located);
}

TEST_F(GivenMap, IsSearchedFirstWhereTheSensorIsToldToBe) {
  EXPECT_FALSE(mapper_.process(rooms_->seenFrom(in_first_)).located());
  mapper_.lookNear(rooms_->inMap(poseOf({4.6, 4.3, 0.1}, 0.3)));
  expectMapped(rooms_->inMap(in_first_), mapper_.process(rooms_->seenFrom(in_first_)));
}

}  // namespace
}  // namespace edgevox::test
