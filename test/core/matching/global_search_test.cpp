// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/matching/global_search.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/matching/branch_and_bound.hpp"
#include "core/scan/scan_sample.hpp"
#include "edgevox/scan/motion.hpp"
#include "support/mapped_world.hpp"
#include "support/random.hpp"
#include "support/sweeps.hpp"

namespace edgevox::test {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180.0;

ScanSample sampleOf(const VoxelScan& scan) { return sampleCentroids(scan, 12000); }

struct Room {
  Config config;
  sim::World world = furnishedRoom();
  MatchMap map;
  GlobalSearch search;

  Room() : map(mapFrom(world, poses(), config)), search(map, config) {}

  static std::vector<Pose> poses() {
    std::vector<Pose> poses;
    for (const double x : {-2.0, -0.5, 1.0}) {
      for (const double y : {-1.5, 0.0, 1.0}) poses.push_back(poseOf({x, y, 0.1}, x - y));
    }
    return poses;
  }
  ScanSample seenFrom(const Pose& pose) const {
    return sampleOf(scanFrom(world, pose, config, 50));
  }
};

const Room& room() {
  static const Room made;
  return made;
}

Pose poseInRoom(Random& random) {
  return poseOf({random.uniform(-2.0, 1.5), random.uniform(-1.5, 1.2), random.uniform(-0.2, 0.3)},
                random.uniform(-3.14, 3.14));
}

void expectNear(const Pose& expected, const Pose& found) {
  const PoseDifference off = differenceOf(expected, found);
  EXPECT_LT(off.metres, 0.05);
  EXPECT_LT(off.degrees, 0.5);
}

TEST(BranchAndBound, FindsWhatLookingEverywhereFinds) {
  Random random(9);
  BitGrid<8> grid;
  const auto uniform = [&](int from, int to) {
    return static_cast<int>(std::floor(random.uniform(from, to)));
  };
  for (int i = 0; i < 400; ++i) grid.set({uniform(-12, 9), uniform(0, 20), uniform(-3, 4)});
  const ShiftPyramid pyramid(grid, 3);
  std::vector<std::vector<VoxelIndex>> points(3);
  for (auto& of_rotation : points) {
    for (int i = 0; i < 30; ++i) {
      of_rotation.push_back({uniform(-9, 9), uniform(-9, 9), uniform(-3, 3)});
    }
  }
  const VoxelBox& box = pyramid.box();
  std::vector<SearchNode> all;
  for (size_t r = 0; r < points.size(); ++r) {
    VoxelIndex v;
    for (v.z = box.first.z; v.z <= box.last.z; ++v.z) {
      for (v.y = box.first.y; v.y <= box.last.y; ++v.y) {
        for (v.x = box.first.x; v.x <= box.last.x; ++v.x) {
          all.push_back({pyramid.hits(0, points[r], v, 0), 0, r, v});
        }
      }
    }
  }
  std::sort(all.begin(), all.end());
  constexpr double kShare = 0.8;
  while (all.back().bound < std::ceil(kShare * all.front().bound)) all.pop_back();
  ASSERT_GT(all.size(), 10U);
  for (const int threads : {1, 4}) {
    SearchControl control;
    control.threads = threads;
    BranchAndBound search(pyramid, points, kShare, 1, control);
    const auto found = search.find(box);
    ASSERT_EQ(all.size(), found.size());
    for (size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(all[i].bound, found[i].bound);
      EXPECT_EQ(all[i].rotation, found[i].rotation);
      EXPECT_EQ(all[i].shift, found[i].shift);
    }
  }
}

TEST(GlobalSearch, FindsScansWithoutAGuess) {
  Random random(3);
  for (int i = 0; i < 10; ++i) {
    const Pose truth = poseInRoom(random);
    const SearchResult result = room().search.search(room().seenFrom(truth), {});
    ASSERT_EQ(SearchOutcome::kFound, result.outcome) << i;
    expectNear(truth, result.answers.front().T_map_sensor);
  }
}

TEST(GlobalSearch, FindsTheSameWithAnyNumberOfThreads) {
  const ScanSample sample = room().seenFrom(poseOf({0.3, 0.2, 0.0}, 1.0));
  SearchControl alone;
  alone.threads = 1;
  const SearchResult one = room().search.search(sample, {}, alone);
  const SearchResult many = room().search.search(sample, {});
  ASSERT_EQ(one.answers.size(), many.answers.size());
  for (size_t i = 0; i < one.answers.size(); ++i) {
    EXPECT_TRUE(sameBits(one.answers[i].T_map_sensor, many.answers[i].T_map_sensor));
  }
}

TEST(GlobalSearch, KnowsWhereUpIs) {
  Pose truth = poseOf({0.3, 0.2, 0.0}, 1.0);
  const Eigen::Matrix3d tilt = rotationOf({0.9, -0.6, 0.0});
  truth.linear() = truth.linear() * tilt;
  const ScanSample sample = room().seenFrom(truth);
  SearchRegion tilted;
  tilted.R_level_sensor = tilt;
  const SearchResult result = room().search.search(sample, tilted);
  ASSERT_EQ(SearchOutcome::kFound, result.outcome);
  expectNear(truth, result.answers.front().T_map_sensor);

  EXPECT_EQ(SearchOutcome::kNotFound, room().search.search(sample, {}).outcome);
  SearchRegion any;
  any.tilt = 65 * kDegree;
  const SearchResult found = room().search.search(sample, any);
  ASSERT_EQ(SearchOutcome::kFound, found.outcome);
  expectNear(truth, found.answers.front().T_map_sensor);
}

TEST(GlobalSearch, LooksAroundAGuessOnly) {
  const Pose truth = poseOf({0.3, 0.2, 0.0}, 1.0);
  const ScanSample sample = room().seenFrom(truth);
  SearchRegion near;
  near.around = SearchRegion::Around{poseOf({1.4, -0.8, 0.2}, 0.5), 1.5, 45 * kDegree};
  const SearchResult result = room().search.search(sample, near);
  ASSERT_EQ(SearchOutcome::kFound, result.outcome);
  expectNear(truth, result.answers.front().T_map_sensor);

  near.around->turn = 10 * kDegree;
  EXPECT_EQ(SearchOutcome::kNotFound, room().search.search(sample, near).outcome);
  near.around = SearchRegion::Around{poseOf({-2.0, 0.2, 0.0}, 1.0), 1.0, 45 * kDegree};
  EXPECT_EQ(SearchOutcome::kNotFound, room().search.search(sample, near).outcome);
}

TEST(GlobalSearch, SaysThatAScanIsOfAnotherPlace) {
  const Config config;
  const sim::World other = twinRooms();
  const ScanSample hall = sampleOf(scanFrom(other, poseOf({20, 1, 0}, 0.0), config, 7));
  EXPECT_EQ(SearchOutcome::kNotFound, room().search.search(hall, {}).outcome);
  const GlobalSearch in_nothing(MatchMap(config.voxel_size, config.map.coarsest_voxel), config);
  const auto nowhere = in_nothing.search(room().seenFrom(poseOf({0, 0, 0}, 0)), {});
  EXPECT_EQ(SearchOutcome::kNotFound, nowhere.outcome);
  EXPECT_EQ(SearchOutcome::kNotFound, room().search.search({}, {}).outcome);
}

TEST(GlobalSearch, SaysThatTwoRoomsLookAlike) {
  const Config config;
  const sim::World world = twinRooms();
  const MatchMap map = mapFrom(world, posesInTwinRooms(), config);
  const GlobalSearch search(map, config);
  const Pose truth = poseOf({3.4, 5.2, 0.0}, 0.8);
  const SearchResult result = search.search(sampleOf(scanFrom(world, truth, config, 99)), {});
  ASSERT_EQ(SearchOutcome::kAmbiguous, result.outcome);
  ASSERT_EQ(2U, result.answers.size());
  const Pose twin = Eigen::Translation3d(12, 0, 0) * truth;
  const bool first = differenceOf(truth, result.answers[0].T_map_sensor).metres < 1.0;
  expectNear(truth, result.answers[first ? 0 : 1].T_map_sensor);
  expectNear(twin, result.answers[first ? 1 : 0].T_map_sensor);

  const Pose in_hall = poseOf({1.0, 1.0, 0.0}, 0.2);
  const SearchResult hall = search.search(sampleOf(scanFrom(world, in_hall, config, 99)), {});
  ASSERT_EQ(SearchOutcome::kFound, hall.outcome);
  expectNear(in_hall, hall.answers.front().T_map_sensor);
}

TEST(GlobalSearch, EndsWhenItIsCancelled) {
  const ScanSample sample = room().seenFrom(poseOf({0.3, 0.2, 0.0}, 1.0));
  std::atomic<bool> cancel{true};
  std::atomic<int> percent{-1};
  SearchControl control;
  control.cancel = &cancel;
  control.percent = &percent;
  const SearchResult result = room().search.search(sample, {}, control);
  EXPECT_EQ(SearchOutcome::kCancelled, result.outcome);
  EXPECT_TRUE(result.answers.empty());
  cancel = false;
  EXPECT_EQ(SearchOutcome::kFound, room().search.search(sample, {}, control).outcome);
  EXPECT_EQ(100, percent);
}

}  // namespace
}  // namespace edgevox::test
