// SPDX-License-Identifier: BSD-3-Clause
#include "core/matching/discrete_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "core/matching/one_answer.hpp"
#include "core/scan/scan_sample.hpp"
#include "edgevox/scan/motion.hpp"
#include "support/mapped_world.hpp"
#include "support/random.hpp"
#include "support/sweeps.hpp"

namespace edgevox::test {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180.0;

struct Room {
  Config config;
  sim::World world = furnishedRoom();
  MatchMap map =
      mapFrom(world, {poseOf({-1.5, -1.0, 0.1}, 0.4), poseOf({1.0, 0.8, 0.1}, 2.0)}, config);
  Pose truth = poseOf({0.3, -0.4, 0.1}, 0.7);
  ScanSample sample = sampleCentroids(scanFrom(world, truth, config, 50), 3000);
};

const Room& room() {
  static const Room made;
  return made;
}

Pose offBy(const Vector3d& translation, const Vector3d& degrees) {
  Pose pose = room().truth;
  pose.translation() += translation;
  pose.linear() = rotationOf(kDegree * degrees) * pose.linear();
  return pose;
}

RestartPoses restartsAround(const Pose& guess, size_t most, uint64_t seed = 7, double reach = 1) {
  return restartPoses(room().map, room().sample, guess, reach, seed, most);
}

/// As somebody would count them.
int hitsOf(const MatchMap& map, int level, const ScanSample& sample, const Pose& pose) {
  int hits = 0;
  for (const Vector3d& point : sample) {
    const Vector3d voxel = pose * point / map.voxelSize(level);
    hits += map.occupied(level).test({static_cast<int32_t>(std::floor(voxel.x())),
                                      static_cast<int32_t>(std::floor(voxel.y())),
                                      static_cast<int32_t>(std::floor(voxel.z()))});
  }
  return hits;
}

TEST(DiscreteSearch, CountsThePointsInOccupiedVoxels) {
  const ScanSample first(room().sample.begin(), room().sample.begin() + 200);
  DiscreteSearch search(room().map, room().sample, first.size());
  const Pose pose = offBy({0.31, -0.17, 0.05}, {1.0, -2.0, 3.0});
  for (int level = 1; level < room().map.levels(); ++level) {
    EXPECT_EQ(hitsOf(room().map, level, first, pose), search.hits(level, pose)) << level;
  }
  EXPECT_EQ(first.size() * static_cast<size_t>(room().map.levels() - 1), search.lookUps());
}

TEST(DiscreteSearch, ClimbsToMoreHits) {
  DiscreteSearch search(room().map, room().sample, 1000);
  const Pose guess = offBy({0.8, -0.5, 0.2}, {4.0, -6.0, 12.0});
  const int level = DiscreteSearch::kFinestLevel;
  const Pose found = search.climb(guess, level);
  EXPECT_GT(search.hits(level, found), search.hits(level, guess) + 100);
  const double size = room().map.voxelSize(level);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double step : {size / 2, -size / 2}) {
      Pose beside = found;
      beside.translation()[axis] += step;
      EXPECT_LE(search.hits(level, beside), search.hits(level, found)) << axis << " " << step;
    }
  }
}

TEST(DiscreteSearch, OfNoPointStays) {
  DiscreteSearch search(room().map, {}, 100);
  const Pose guess = offBy({0.8, 0, 0}, {0, 0, 5.0});
  EXPECT_EQ(0, search.hits(1, guess));
  EXPECT_TRUE(search.climb(guess).matrix() == guess.matrix());
}

TEST(RestartPoses, AreTheBestOfTheirKindAndDistinct) {
  const RestartPoses starts = restartsAround(offBy({1.0, -0.7, 0.2}, {5.0, -8.0, 20.0}), 60);
  ASSERT_EQ(60U, starts.best.size());
  EXPECT_EQ(200000U, starts.look_ups);
  EXPECT_EQ(1.6, room().map.voxelSize(starts.level));
  DiscreteSearch search(room().map, room().sample, 100);
  for (size_t i = 0; i + 1 < starts.best.size(); ++i) {
    EXPECT_GE(search.hits(starts.level, starts.best[i]),
              search.hits(starts.level, starts.best[i + 1]));
    for (size_t j = i + 1; j < starts.best.size(); ++j) {
      EXPECT_FALSE(areNear(starts.best[i], starts.best[j], 0.39, 4.9 * kDegree)) << i << " " << j;
    }
  }
}

TEST(RestartPoses, AreWithinReach) {
  const Pose guess = offBy({0.5, 0, 0}, {0, 0, 10.0});
  for (const double reach : {0.5, 3.0}) {
    double farthest = 0.0;
    for (const Pose& start : restartsAround(guess, 2000, 7, reach).best) {
      const Vector3d off = start.translation() - guess.translation();
      EXPECT_LE(off.cwiseAbs().maxCoeff(), 2.0 * reach);
      farthest = std::max(farthest, off.cwiseAbs().maxCoeff());
    }
    EXPECT_GT(farthest, 1.5 * reach);
  }
}

TEST(RestartPoses, DependOnNothingButTheSeed) {
  const auto sameBits = [](const Pose& a, const Pose& b) {
    return std::memcmp(a.data(), b.data(), sizeof(double) * 16) == 0;
  };
  const RestartPoses once = restartsAround(room().truth, 20);
  const RestartPoses again = restartsAround(room().truth, 20);
  const RestartPoses other = restartsAround(room().truth, 20, 8);
  ASSERT_EQ(once.best.size(), again.best.size());
  for (size_t i = 0; i < once.best.size(); ++i) {
    EXPECT_TRUE(sameBits(once.best[i], again.best[i])) << i;
  }
  EXPECT_FALSE(sameBits(once.best[0], other.best[0]));
}

TEST(RestartPoses, OfFinerVoxelsAreAsFarApart) {
  Config config;
  config.voxel_size = 0.05;
  const MatchMap map = mapFrom(room().world, {room().truth}, config);
  const RestartPoses starts = restartPoses(map, room().sample, room().truth, 1.0, 7, 5);
  EXPECT_EQ(1.6, map.voxelSize(starts.level));
  config.voxel_size = 1.0;
  const MatchMap coarse = mapFrom(room().world, {room().truth}, config);
  EXPECT_EQ(DiscreteSearch::kFinestLevel,
            restartPoses(coarse, room().sample, room().truth, 1.0, 7, 5).level);
}

}  // namespace
}  // namespace edgevox::test
