// SPDX-License-Identifier: BSD-3-Clause
#include "core/matching/discrete_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "core/matching/one_answer.hpp"
#include "core/scan/scan_sample.hpp"
#include "edgevox/edges/edge_extractor.hpp"
#include "edgevox/map/map_builder.hpp"
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

/// One voxel list a level, and every move tried in turn, from the description alone.
class NaiveClimb {
 public:
  NaiveClimb(const std::vector<VoxelIndex>& voxels, double voxel_size, int levels)
      : voxel_size_(voxel_size), lists_(static_cast<size_t>(levels)) {
    for (const VoxelIndex& v : voxels) {
      for (size_t level = 0; level < lists_.size(); ++level) {
        const double side = std::ldexp(1.0, static_cast<int>(level));
        lists_[level].insert(
            {std::floor(v.x / side), std::floor(v.y / side), std::floor(v.z / side)});
      }
    }
  }

  Pose from(Pose pose, const ScanSample& points) const {
    for (int level = static_cast<int>(lists_.size()) - 1; level >= 0; --level) {
      const double scale = std::ldexp(1.0, level);
      pose = pass(pose, points, level, voxel_size_ * scale, 0.25 * kDegree * scale);
    }
    return pass(pose, points, 0, voxel_size_ / 4, 0.25 * kDegree / 4);
  }

 private:
  using Index = std::array<double, 3>;

  int count(const Pose& pose, const ScanSample& points, int level) const {
    int count = 0;
    for (const Vector3d& point : points) {
      const Vector3d v = pose * point / (voxel_size_ * std::ldexp(1.0, level));
      count += static_cast<int>(lists_[static_cast<size_t>(level)].count(
          {std::floor(v.x()), std::floor(v.y()), std::floor(v.z())}));
    }
    return count;
  }

  static Pose moved(const Pose& pose, int axis, double by) {
    Pose out = pose;
    const Vector3d along = by * Vector3d::Unit(axis % 3);
    if (axis < 3) out.translation() += along;
    if (axis >= 3) out.linear() = rotationOf(along) * pose.linear();
    return out;
  }

  Pose pass(Pose pose, const ScanSample& points, int level, double step, double angle) const {
    int best = count(pose, points, level);
    for (bool gains = true; gains;) {
      Pose next = pose;
      const auto look = [&](const Pose& candidate) {
        const int hits = count(candidate, points, level);
        if (hits > best) {
          best = hits;
          next = candidate;
        }
      };
      for (int axis = 0; axis < 6; ++axis) {
        for (const double sign : {1.0, -1.0}) {
          look(moved(pose, axis, sign * (axis < 3 ? step : angle)));
        }
      }
      for (int t = 0; t < 3; ++t) {
        for (int r = 3; r < 6; ++r) {
          for (const double st : {1.0, -1.0}) {
            for (const double sr : {1.0, -1.0})
              look(moved(moved(pose, t, st * step), r, sr * angle));
          }
        }
      }
      gains = next.matrix() != pose.matrix();
      pose = next;
    }
    return pose;
  }

  double voxel_size_;
  std::vector<std::set<Index>> lists_;
};

/// The edges of scans alone, at 5 cm, as the preset paper has them.
struct EdgeRoom {
  Config config;
  MapBuilder builder;
  VoxelScan scan;

  EdgeRoom() : config(configOf()), builder(config.voxel_size, config.map, config.edges, 1) {
    for (const double x : {-1.0, 0.2, 0.9}) {
      const Pose pose = poseOf({x, -0.3 * x, 0.1}, 0.5 + x);
      std::vector<Vector3d> centroids;
      for (const ScanVoxel& voxel : edgesFrom(pose).voxels) {
        centroids.push_back(pose * voxel.centroid.cast<double>());
      }
      builder.insert(centroids, pose.translation());
    }
    scan = edgesFrom(room().truth);
  }

  static Config configOf() {
    Config config;
    config.voxel_size = 0.05;
    config.edges.mode = EdgeMode::kPaper;
    config.map.representation = Representation::kAll;
    config.map.min_hits = 1;
    config.map.confirm_within = 0;
    config.map.freeze_after = 0;
    config.map.coarsest_voxel = 1.6;
    return config;
  }

  VoxelScan edgesFrom(const Pose& pose) const {
    VoxelScan scan = scanFrom(room().world, pose, config, 50);
    EdgeExtractor(config.edges, 1).extract(scan);
    return edgeVoxels(scan);
  }
};

TEST(PublishedClimb, OnEdgesIsThatOfANaiveOne) {
  const EdgeRoom made;
  std::vector<VoxelIndex> voxels;
  made.builder.matchMap().hitVoxels().forEach([&](const VoxelIndex& v) { voxels.push_back(v); });
  ASSERT_GT(voxels.size(), 1000U);
  const NaiveClimb naive(voxels, made.config.voxel_size, 6);
  const ScanSample sample = sampleCentroids(made.scan, 400);
  ASSERT_EQ(400U, sample.size());
  DiscreteSearch search(made.builder.matchMap(), sample, sample.size());
  for (const double off : {0.05, 0.3, 0.8}) {
    const Pose guess = offBy({off, -off / 2, off / 4}, {4 * off, -3 * off, 10 * off});
    const PoseDifference between =
        differenceOf(naive.from(guess, sample), search.climbAsPublished(guess));
    EXPECT_LT(between.metres, 1e-9) << off;
    EXPECT_LT(between.degrees, 1e-6) << off;
  }
}

TEST(PublishedClimb, OnEdgesFindsThePose) {
  const EdgeRoom made;
  const ScanSample sample = sampleCentroids(made.scan, made.scan.voxels.size());
  DiscreteSearch search(made.builder.matchMap(), sample, sample.size());
  const PoseDifference off = differenceOf(
      room().truth, search.climbAsPublished(offBy({0.2, -0.15, 0.05}, {1.0, -1.0, 4.0})));
  EXPECT_LT(off.metres, 0.05);
  EXPECT_LT(off.degrees, 1.0);
}

TEST(RestartPoses, AreTheBestOfTheirKindAndDistinct) {
  const RestartPoses starts = restartsAround(offBy({1.0, -0.7, 0.2}, {5.0, -8.0, 20.0}), 60);
  ASSERT_EQ(60U, starts.best.size());
  EXPECT_EQ(200000U, starts.look_ups);
  const int level = starts.level - 1;  // by which they are compared
  EXPECT_EQ(1.6, room().map.voxelSize(level));
  DiscreteSearch search(room().map, room().sample, 100);
  for (size_t i = 0; i + 1 < starts.best.size(); ++i) {
    EXPECT_GE(search.hits(level, starts.best[i]), search.hits(level, starts.best[i + 1]));
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
  EXPECT_EQ(3.2, map.voxelSize(starts.level));
  config.voxel_size = 1.0;
  const MatchMap coarse = mapFrom(room().world, {room().truth}, config);
  EXPECT_EQ(DiscreteSearch::kFinestLevel + 1,
            restartPoses(coarse, room().sample, room().truth, 1.0, 7, 5).level);
}

}  // namespace
}  // namespace edgevox::test
