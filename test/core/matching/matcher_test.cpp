// SPDX-License-Identifier: BSD-3-Clause
// Scans of a simulated room against its map, from guesses that are known to be wrong.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/matching/discrete_search.hpp"
#include "core/scan/scan_sample.hpp"
#include "edgevox/map/map_builder.hpp"
#include "edgevox/matching/free_space.hpp"
#include "edgevox/matching/matcher.hpp"
#include "edgevox/scan/motion.hpp"
#include "support/mapped_world.hpp"
#include "support/random.hpp"
#include "support/sweeps.hpp"

namespace edgevox::test {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180.0;

sim::Sensor roomSensor() {
  sim::Sensor sensor = sim::makeSensor("32");
  sensor.columns = 512;
  return sensor;
}

/// The furnished room mapped from true poses, and a scan that is not in the map.
struct MappedRoom {
  static Config configOf() {
    Config config;
    config.voxel_size = 0.1;
    config.map.coarsest_voxel = 3.2;
    return config;
  }

  Config config;
  sim::World world = furnishedRoom();
  MapBuilder builder;
  const MatchMap& map = builder.matchMap();
  Pose truth = poseOf({0.55, -0.4, 0.1}, 0.7);
  ScanSample sample;

  MappedRoom() : config(configOf()), builder(config.voxel_size, config.map, config.edges, 1) {
    Random random(3);
    for (uint32_t i = 0; i < 20; ++i) {
      const Vector3d position{random.uniform(-2, 2), random.uniform(-1.5, 1.5),
                              random.uniform(-0.2, 0.3)};
      const Pose pose = poseOf(position, random.uniform(-3, 3));
      std::vector<Vector3d> centroids;
      for (const ScanVoxel& voxel : scanFrom(pose, i).voxels) {
        centroids.push_back(pose * voxel.centroid.cast<double>());
      }
      builder.insert(centroids, pose.translation());
    }
    builder.label();
    builder.prepareAll();
    sample = sampleCentroids(scanFrom(truth, 100), 3000);
  }

  VoxelScan scanFrom(const Pose& pose, uint32_t seed) const {
    const auto sweep = castSweep(
        world, roomSensor(), [&](double) { return pose; }, 0.0, seed);
    return voxelScans({sweep}, config)[0];
  }

  Matcher matcher() const { return Matcher(config.matcher); }
  size_t searchPoints() const { return static_cast<size_t>(config.matcher.search_points); }
};

const MappedRoom& mappedRoom() {
  static const MappedRoom mapped;
  return mapped;
}

/// A draw from a normal distribution, of each component.
Pose disturbed(const Pose& pose, double metres, double degrees, Random& random) {
  Pose out = pose;
  out.translation() += metres * random.normalVector();
  out.linear() = rotationOf(degrees * kDegree * random.normalVector()) * pose.linear();
  return out;
}

/// Exactly so far off, in a random direction.
Pose displaced(const Pose& pose, double metres, double degrees, Random& random) {
  Pose out = pose;
  out.translation() += metres * random.normalVector().normalized();
  out.linear() = rotationOf(degrees * kDegree * random.normalVector().normalized()) * pose.linear();
  return out;
}

/// Of 40 guesses, the number from which `align` comes near the truth.
using Align = std::function<Pose(const Pose& guess)>;
int captured(double metres, double degrees, const PoseDifference& near, const Align& align) {
  Random random(17);
  int count = 0;
  for (int i = 0; i < 40; ++i) {
    const Pose found = align(disturbed(mappedRoom().truth, metres, degrees, random));
    const PoseDifference error = differenceOf(mappedRoom().truth, found);
    count += error.metres < near.metres && error.degrees < near.degrees ? 1 : 0;
  }
  return count;
}

constexpr PoseDifference kNear{0.03, 0.3};

Pose refined(const Pose& guess) {
  const MappedRoom& room = mappedRoom();
  Matcher::Refinement refinement;
  refinement.start = refinement.predicted.T_map_sensor = guess;
  return room.matcher().refine(room.map, room.sample, refinement).T_map_sensor;
}

Pose searchedAndRefined(const Pose& guess) {
  const MappedRoom& room = mappedRoom();
  return refined(DiscreteSearch(room.map, room.sample, room.searchPoints()).climb(guess));
}

TEST(Refinement, RecoversAPoseNearby) {
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    const Pose guess = displaced(mappedRoom().truth, 0.1, 2.0, random);
    const PoseDifference error = differenceOf(mappedRoom().truth, refined(guess));
    EXPECT_LT(error.metres, 0.01);
    EXPECT_LT(error.degrees, 0.2);
  }
}

TEST(Search, WidensTheCapture) {
  const int alone = captured(0.5, 10, kNear, refined);
  const int searched = captured(0.5, 10, kNear, searchedAndRefined);
  const int far_alone = captured(1.0, 20, kNear, refined);
  const int far_searched = captured(1.0, 20, kNear, searchedAndRefined);
  RecordProperty("refined_0.5m_10deg", alone);
  RecordProperty("searched_0.5m_10deg", searched);
  RecordProperty("refined_1m_20deg", far_alone);
  RecordProperty("searched_1m_20deg", far_searched);
  EXPECT_GE(searched, 32);
  EXPECT_GE(far_searched, 30);
  EXPECT_LT(alone, searched - 20);
  EXPECT_LT(far_alone, far_searched - 20);
}

TEST(PublishedMode, ComesWithinAVoxel) {
  const MappedRoom& room = mappedRoom();
  MatcherConfig config;
  config.mode = MatcherMode::kPublished;
  Random random(19);
  int near = 0;
  for (int i = 0; i < 40; ++i) {
    MatchRequest request;
    request.guess.T_map_sensor = displaced(room.truth, 0.3, 5.0, random);
    const Pose found = Matcher(config).align(room.map, room.sample, request).T_map_sensor;
    const PoseDifference error = differenceOf(room.truth, found);
    near += error.metres < room.map.voxelSize(1) && error.degrees < 5.0 ? 1 : 0;
  }
  RecordProperty("captured", near);
  EXPECT_GE(near, 30);
}

/// Counted point by point in a set.
double naiveHitRatio(const MatchMap& map, const ScanSample& sample, const Pose& pose) {
  std::array<int, 4> hits{};
  for (const int level : {1, 3}) {
    std::set<VoxelIndex> occupied;
    map.occupied(level).forEach([&](const VoxelIndex& v) { occupied.insert(v); });
    for (const Vector3d& p : sample) {
      const VoxelIndex v = voxelAt(Vector3d(pose * p), 1.0 / map.voxelSize(level));
      hits[static_cast<size_t>(level)] += static_cast<int>(occupied.count(v));
    }
  }
  return hits[1] / std::max<double>(hits[3], static_cast<double>(sample.size()) / 4);
}

TEST(HitRatio, IsThatOfANaiveCount) {
  const MappedRoom& room = mappedRoom();
  Random random(7);
  double least = 1.0;
  for (int i = 0; i < 12; ++i) {
    const Pose pose = displaced(room.truth, 0.25 * i, 2.0 * i, random);
    const double expected = naiveHitRatio(room.map, room.sample, pose);
    // A point may lie so near to a voxel's face that rounding decides.
    EXPECT_NEAR(expected, Matcher::hits(room.map, room.sample, room.sample.size(), pose).ratio,
                2.5 / 3000);
    least = std::min(least, expected);
  }
  EXPECT_GT(Matcher::hits(room.map, room.sample, room.sample.size(), room.truth).ratio, 0.9);
  EXPECT_LT(least, 0.5);
}

TEST(HitRatio, TellsNothingOfUnknownSpace) {
  const MappedRoom& room = mappedRoom();
  const ScanSample known(room.sample.begin(), room.sample.begin() + 500);
  const double ratio = Matcher::hits(room.map, known, known.size(), room.truth).ratio;
  ScanSample partly = known;
  for (int i = 0; i < 1000; ++i) partly.push_back({100.0 + i, 0, 0});
  EXPECT_DOUBLE_EQ(ratio, Matcher::hits(room.map, partly, partly.size(), room.truth).ratio);
  for (int i = 0; i < 3500; ++i) partly.push_back({0, 100.0 + i, 0});
  EXPECT_LT(Matcher::hits(room.map, partly, partly.size(), room.truth).ratio,
            0.45);  // a tenth of a quarter
  EXPECT_EQ(0.0, Matcher::hits(room.map, {}, 3000, room.truth).ratio);
}

TEST(Restarts, FindAPoseFarFromTheGuess) {
  const MappedRoom& room = mappedRoom();
  Random random(11);
  int from_guess = 0;
  int with_restarts = 0;
  for (int i = 0; i < 24; ++i) {
    MatchRequest request;
    request.guess.T_map_sensor = displaced(room.truth, 1.8, i % 2 == 0 ? 10.0 : 40.0, random);
    request.required_hit_ratio = 0.75;
    request.all_voxels = true;
    request.seed = static_cast<uint64_t>(i);
    const auto isRight = [&](const MatchResult& result) {
      return result.accepted() && differenceOf(room.truth, result.T_map_sensor).metres < 0.03;
    };
    from_guess += isRight(room.matcher().align(room.map, room.sample, request)) ? 1 : 0;
    const MatchResult found = room.matcher().match(room.map, room.sample, request);
    with_restarts += isRight(found) ? 1 : 0;
  }
  RecordProperty("from_guess", from_guess);
  RecordProperty("with_restarts", with_restarts);
  EXPECT_GE(with_restarts, 23);
  EXPECT_LT(from_guess, with_restarts);
}

TEST(Match, OfAnotherPlaceIsNotAccepted) {
  const MappedRoom& room = mappedRoom();
  const sim::World building = sim::makeWorld(sim::WorldName::Building, 1);
  const sim::Trajectory path = sim::makeTrajectory(sim::WorldName::Building);
  double best = 0.0;
  for (const double time : {30.0, 60.0, 90.0}) {
    const auto sweep = castSweep(
        building, roomSensor(), [&](double) { return path.poseAt(time); }, 0.0, 1);
    MatchRequest request;
    request.guess.T_map_sensor = room.truth;
    const double usual = Matcher::hits(room.map, room.sample, room.sample.size(), room.truth).ratio;
    request.required_hit_ratio = 0.75 * usual;
    request.far_hit_ratio = 0.95 * usual;
    request.all_voxels = true;
    const auto result = room.matcher().match(
        room.map, sampleCentroids(voxelScans({sweep}, room.config)[0], 3000), request);
    EXPECT_FALSE(result.accepted()) << time;
    EXPECT_TRUE(result.restarts == room.config.matcher.max_restarts || result.look_ups > 12000000U)
        << result.restarts << " restarts, " << result.look_ups << " look-ups";
    EXPECT_GT(result.restarts, 20);
    best = std::max(best, result.hit_ratio);
  }
  RecordProperty("best_hit_ratio", std::to_string(best));
}

TEST(Match, TooFarFromTheGuessIsNotAccepted) {
  const MappedRoom& room = mappedRoom();
  MatchRequest request;
  request.guess.T_map_sensor = room.truth;
  request.guess.T_map_sensor.translation().x() += 0.6;
  request.required_hit_ratio = 0.8;
  MatcherConfig config;
  config.max_restarts = 0;
  const Matcher matcher(config);
  for (const double farthest : {0.5, 4.5}) {
    request.max_translation = farthest;
    const MatchResult result = matcher.match(room.map, room.sample, request);
    EXPECT_EQ(farthest > 0.6, result.accepted()) << farthest << ": " << result.hit_ratio;
    EXPECT_EQ(farthest > 0.6 ? Refusal::kNone : Refusal::kTooFar, result.refusal);
    if (result.accepted()) EXPECT_LT(differenceOf(room.truth, result.T_map_sensor).metres, 0.03);
  }
  // Farther off more is asked.
  request.far_hit_ratio = 1.01;
  request.far_translation = 0.5;
  const MatchResult far = matcher.match(room.map, room.sample, request);
  EXPECT_FALSE(far.accepted());
  EXPECT_EQ(Refusal::kFewHits, far.refusal);
  EXPECT_EQ(1.01, far.required_hit_ratio);
  request.far_translation = 0.8;
  EXPECT_TRUE(matcher.match(room.map, room.sample, request).accepted());
}

double blockedAt(const Pose& pose) {
  const MappedRoom& room = mappedRoom();
  return blockedShare(room.map, room.sample, 500, pose);
}

TEST(FreeSpace, LinesOfSightAreBlockedWhereThePoseIsWrong) {
  const Pose& truth = mappedRoom().truth;
  EXPECT_LT(blockedAt(truth), 0.01);
  double least = 1.0;
  for (const Vector3d& off : {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0),
                              Vector3d(0, -1, 0), Vector3d(0, 0, 0.5)}) {
    Pose wrong = truth;
    wrong.translation() += off;
    least = std::min(least, blockedAt(wrong));
  }
  RecordProperty("truth", std::to_string(blockedAt(truth)));
  RecordProperty("least_wrong", std::to_string(least));
  EXPECT_GT(least, 0.05);
}

TEST(FreeSpace, MatchesThatSeeThroughWallsAreNotAccepted) {
  const MappedRoom& room = mappedRoom();
  MatcherConfig config;
  config.max_restarts = 0;
  config.search_points = config.refine_points = 1;  // the pose stays wrong
  MatchRequest request;
  request.guess.T_map_sensor = room.truth;
  request.guess.T_map_sensor.translation().x() += 1.5;
  const auto matched = [&] { return Matcher(config).align(room.map, room.sample, request); };
  EXPECT_TRUE(matched().accepted());
  request.most_blocked = request.most_blocked_near = 0.1;
  const MatchResult result = matched();
  EXPECT_FALSE(result.accepted());
  EXPECT_EQ(Refusal::kBlocked, result.refusal);
  EXPECT_GT(result.blocked, 0.1);
}

TEST(Match, IsTheSameEveryTime) {
  const MappedRoom& room = mappedRoom();
  const MappedRoom again;
  Random random(13);
  MatchRequest request;
  request.guess.T_map_sensor = displaced(room.truth, 1.8, 10.0, random);
  request.required_hit_ratio = 0.75;
  const MatchResult a = room.matcher().match(room.map, room.sample, request);
  const MatchResult b = again.matcher().match(again.map, again.sample, request);
  EXPECT_TRUE(sameBits(a.T_map_sensor, b.T_map_sensor));
  EXPECT_EQ(a.hit_ratio, b.hit_ratio);
  EXPECT_EQ(a.restarts, b.restarts);
  EXPECT_EQ(0, std::memcmp(a.information.data(), b.information.data(), 36 * sizeof(double)));
}

TEST(Match, OfRandomPointsHasAnEnd) {
  const MappedRoom& room = mappedRoom();
  MatchRequest request;
  request.guess.T_map_sensor = room.truth;
  request.required_hit_ratio = 0.99;
  request.reach = 4.0;
  request.all_voxels = true;
  const ScanSample random =
      sampleCentroids(voxelScans({randomSweep(5, 0.0, 100000)}, room.config)[0], 12000);
  const MatchResult result = room.matcher().match(room.map, random, request);
  RecordProperty("look_ups", static_cast<int>(result.look_ups));
  EXPECT_FALSE(result.accepted());
  EXPECT_GT(result.restarts, 5);
  EXPECT_LT(result.look_ups, 13000000U);
}

TEST(Match, BesideTheGridIsNone) {
  const MappedRoom& room = mappedRoom();
  const double nan = std::nan("");
  for (const MatcherMode mode : {MatcherMode::kRefined, MatcherMode::kPublished}) {
    MatcherConfig config;
    config.mode = mode;
    for (const double absurd : {2e5, 1e12, -1e80, 1e300, nan}) {
      MatchRequest request;
      request.guess.T_map_sensor = room.truth;
      request.guess.T_map_sensor.translation().y() = absurd;
      EXPECT_FALSE(Matcher(config).match(room.map, room.sample, request).accepted()) << absurd;
      request.guess.T_map_sensor = room.truth;
      ScanSample sample = room.sample;
      sample[sample.size() / 2].z() = absurd;
      EXPECT_FALSE(Matcher(config).match(room.map, sample, request).accepted()) << absurd;
    }
    MatchRequest request;
    request.guess.T_map_sensor = room.truth;
    request.guess.T_map_sensor.linear()(1, 2) = nan;
    EXPECT_FALSE(Matcher(config).match(room.map, room.sample, request).accepted());
  }
}

TEST(Refinement, EndsWhereItLeavesTheGrid) {
  const MappedRoom& room = mappedRoom();
  const double limit = kIndexLimit * room.config.voxel_size;
  MapBuilder builder(room.config.voxel_size, room.config.map, room.config.edges, 1);
  std::vector<Vector3d> wall;  // at the limit
  for (int i = 0; i < 400; ++i) wall.emplace_back(limit - 0.25, 0.05 * (i / 20), 0.05 * (i % 20));
  for (int i = 0; i < 3; ++i) builder.insert(wall, {0, 0, 0});
  builder.label();
  builder.prepareAll();
  ScanSample sample = wall;
  for (Vector3d& point : sample) point.x() -= limit - 5;
  Matcher::Refinement refinement;
  refinement.start.translation().x() = limit - 5.0 + 0.2;
  refinement.predicted.T_map_sensor = refinement.start;
  refinement.all_voxels = true;
  const MatchResult result = room.matcher().refine(builder.matchMap(), sample, refinement);
  EXPECT_GT(result.matches, 100);
  EXPECT_TRUE(result.T_map_sensor.matrix().allFinite());
}

TEST(Match, OfNothingIsHarmless) {
  const MappedRoom& room = mappedRoom();
  MatchRequest request;
  request.guess.T_map_sensor = room.truth;
  request.required_hit_ratio = 0.5;
  const MatchResult result = room.matcher().match(room.map, {{0, 0, 50}, {1, 0, 50}}, request);
  EXPECT_FALSE(result.accepted());
  EXPECT_TRUE(result.T_map_sensor.matrix().allFinite());
}

/// Two rooms side by side, alike but for a cupboard in one of them, if there is one; the sample is
/// of that one.
struct RoomsAlike {
  static constexpr double kApart = 2.5;  // [m]

  Config config;
  MapBuilder builder{config.voxel_size, config.map, config.edges, 1};
  ScanSample sample;

  explicit RoomsAlike(bool cupboard) {
    Random random(11);
    for (int i = 0; i < 3; ++i) {
      for (const double x : {0.0, kApart}) {
        std::vector<Vector3d> points = room(cupboard && x == 0.0, random);
        for (Vector3d& point : points) point.x() += x;
        builder.insert(points, {x, 0, 0});
      }
    }
    builder.label();
    builder.prepareAll();
    sample = room(cupboard, random);
  }

  /// From the door between the rooms.
  MatchResult match() const {
    MatchRequest request;
    request.guess.T_map_sensor.translation().x() = 0.45 * kApart;
    request.required_hit_ratio = 0.7;
    request.trusted_hit_ratio = 1.1;
    request.far_translation = 10.0;
    request.doubtful = true;
    return Matcher(config.matcher).match(builder.matchMap(), sample, request);
  }

 private:
  static std::vector<Vector3d> room(bool cupboard, Random& random) {
    constexpr double kHalf = 1.2;  // [m]
    std::vector<Vector3d> points;
    for (int i = 0; i < 9000; ++i) {
      Vector3d point(random.uniform(-kHalf, kHalf), random.uniform(-kHalf, kHalf),
                     random.uniform(-kHalf, kHalf));
      point[i % 3] = i % 2 == 0 ? kHalf : -kHalf;
      if (cupboard && i % 5 == 0) point = {0.6, point.y() / 4, point.z()};
      points.push_back(point + 0.005 * random.normalVector());
    }
    return points;
  }
};

TEST(Matcher, DoesNotChooseBetweenPlacesThatFitAlike) {
  const MatchResult result = RoomsAlike(false).match();
  EXPECT_EQ(Refusal::kAmbiguous, result.refusal);
  EXPECT_GT(result.hit_ratio, 0.9);
}

TEST(Matcher, ChoosesThePlaceThatFitsBetter) {
  const MatchResult result = RoomsAlike(true).match();
  EXPECT_EQ(Refusal::kNone, result.refusal);
  EXPECT_LT(result.T_map_sensor.translation().norm(), 0.05);
}

}  // namespace
}  // namespace edgevox::test
