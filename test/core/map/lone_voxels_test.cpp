// SPDX-License-Identifier: BSD-3-Clause
// Points that stand alone wait outside the map, and the memory of a map is bounded.
#include <algorithm>
#include <vector>

#include <Eigen/Core>

#include <gtest/gtest.h>

#include "edgevox/map/map_builder.hpp"
#include "support/random.hpp"
#include "support/scans.hpp"

namespace edgevox::test {
namespace {

using Eigen::Vector3d;

constexpr double kSize = 0.2;      // [m]
constexpr int kConfirmWithin = 6;  // [scans]
const Vector3d kLone(30.1, 20.1, 5.1);

MapBuilder makeMap(const MapConfig& config) { return MapBuilder(kSize, config, EdgeConfig{}, 1); }

MapConfig confirming(int scans) {
  MapConfig config;
  config.confirm_within = scans;
  return config;
}

/// Floor, ceiling and walls of a room of 8 x 6 x 3 m, points 7 cm apart.
Centroids room() {
  Centroids points;
  for (double x = -4; x <= 4; x += 0.07) {
    for (double y = -3; y <= 3; y += 0.07) {
      for (const double z : {0.03, 3.03}) points.emplace_back(x, y, z);
    }
    for (double z = 0; z <= 3; z += 0.07) {
      for (const double y : {-3.03, 3.03}) points.emplace_back(x, y, z);
    }
  }
  return points;
}

bool isInMap(const MapBuilder& map, const Vector3d& point) {
  return map.matchMap().occupied(1).test(voxelAt(point, 1.0 / map.voxelSize(1)));
}

void insert(const Centroids& points, MapBuilder& map) { map.insert(points, {0, 0, 1.5}); }

TEST(LonePoint, EntersTheMapWhenALaterScanConfirmsIt) {
  for (int pause = 0; pause < kConfirmWithin / 2; ++pause) {
    MapBuilder map = makeMap(confirming(kConfirmWithin));
    insert({kLone}, map);
    EXPECT_FALSE(isInMap(map, kLone));
    EXPECT_EQ(1U, map.loneCentroids());
    for (int i = 0; i < pause; ++i) insert({}, map);
    insert({kLone + Vector3d(0.05, 0, 0)}, map);
    EXPECT_TRUE(isInMap(map, kLone)) << pause;
    EXPECT_EQ(1U, map.loneCentroids());
  }
}

TEST(LonePoint, IsForgottenWithoutASecondHit) {
  MapBuilder map = makeMap(confirming(kConfirmWithin));
  for (int round = 0; round < 5; ++round) {
    insert({kLone}, map);
    for (int i = 0; i < kConfirmWithin; ++i) insert({}, map);
  }
  EXPECT_FALSE(isInMap(map, kLone));
  EXPECT_EQ(5U, map.loneCentroids());
}

TEST(LonePoint, EntersAtOnceIfAsked) {
  MapBuilder map = makeMap(confirming(0));
  insert({kLone}, map);
  EXPECT_TRUE(isInMap(map, kLone));
  EXPECT_EQ(0U, map.loneCentroids());
}

TEST(LonePoint, HasNoTwoOthersOfItsScanBesideIt) {
  const Vector3d step(2 * kSize, 0, 0);
  MapBuilder map = makeMap(confirming(kConfirmWithin));
  insert({kLone, kLone + step}, map);
  EXPECT_FALSE(isInMap(map, kLone));
  EXPECT_EQ(2U, map.loneCentroids());
  insert({kLone + 8 * step, kLone + 9 * step, kLone + 10 * step}, map);
  EXPECT_TRUE(isInMap(map, kLone + 9 * step));
}

TEST(LonePoint, IsNotAloneBesideWhatTheMapKnowsWell) {
  MapBuilder map = makeMap(confirming(kConfirmWithin));
  const Vector3d behind_wall(0.1, 3.5, 1.5);
  insert(room(), map);
  insert({behind_wall}, map);
  EXPECT_FALSE(isInMap(map, behind_wall));  // what one scan has seen may be noise as well
  insert(room(), map);
  insert({behind_wall + Vector3d(2, 0, 0)}, map);
  EXPECT_TRUE(isInMap(map, behind_wall + Vector3d(2, 0, 0)));
}

TEST(LonePoint, OfASurfaceThereIsNone) {
  MapBuilder map = makeMap(confirming(kConfirmWithin));
  for (int i = 0; i < 5; ++i) insert(room(), map);
  EXPECT_EQ(0U, map.loneCentroids());
}

size_t bytesOfRoom(int scans, int noise_points) {
  Random random(3);
  MapBuilder map = makeMap({});
  for (int scan = 0; scan < scans; ++scan) {
    Centroids points = room();
    for (int i = 0; i < noise_points; ++i) points.push_back(random.vectorIn(-60, 60));
    insert(points, map);
  }
  return map.bytes();
}

TEST(Noise, TakesNoMoreMemoryThanTheRoomItself) {
  const size_t clean = bytesOfRoom(60, 0);
  const size_t early = bytesOfRoom(60, 1000);
  const size_t late = bytesOfRoom(240, 1000);
  RecordProperty("clean", static_cast<int>(clean));
  RecordProperty("noisy", static_cast<int>(late));
  EXPECT_LT(late, 2 * clean);
  EXPECT_LT(late, early + early / 10);
}

TEST(Memory, NoNewVoxelsEnterAMapThatIsAsLargeAsItMayBe) {
  MapConfig config;
  config.memory = 1;
  MapBuilder map = makeMap(config);
  Centroids place = room();
  const auto next = [&] {
    for (Vector3d& point : place) point.x() += 9.0;
  };
  while (map.bytes() < 1000000) {
    insert(place, map);
    next();
  }
  EXPECT_EQ(0U, map.centroidsPastMemory());
  EXPECT_FALSE(map.isFull());
  const size_t bytes = map.bytes();
  const size_t cells = map.moments().size();
  insert(place, map);
  EXPECT_EQ(place.size(), map.centroidsPastMemory());
  EXPECT_EQ(cells, map.moments().size());
  EXPECT_TRUE(map.isFull());
  EXPECT_NE(std::string::npos, fullText(config).find("map/memory, 1 MB"));
  EXPECT_LE(map.bytes(), bytes + bytes / 10);
  const Vector3d known = room().front();
  const uint32_t slot = map.matchMap().surfaces().slotOf(voxelAt(known, 1.0 / map.voxelSize(1)));
  const uint32_t count = map.moments().cell(slot).count;
  insert({known}, map);
  EXPECT_EQ(count + 1, map.moments().cell(slot).count);  // but known ones are kept up to date
}

}  // namespace
}  // namespace edgevox::test
