// SPDX-License-Identifier: BSD-3-Clause
// Voxels that later scans see through leave the map, and nothing else does.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>

#include "edgevox/map/map_builder.hpp"
#include "support/random.hpp"
#include "support/reference_extractor.hpp"
#include "support/scans.hpp"
#include "support/voxel_sets.hpp"

namespace edgevox::test {
namespace {

using Eigen::Vector3d;

constexpr double kSize = kScanMapVoxel;
constexpr int kClearAfter = 3;

enum class Box { kThere, kGone };

/// A hall in front of the sensor, and a box in it [m].
const Vector3d kHallMin(-1, -3, -1.23);
const Vector3d kHallMax(6.04, 3, 1.5);
const Vector3d kBoxMin(3.02, -0.5, -1.23);
const Vector3d kBoxMax(3.98, 0.5, 0.3);

/// Where a ray from outside enters the box, in lengths of `ray`; infinite if it does not.
double rangeOfBox(const Vector3d& from, const Vector3d& ray) {
  const Eigen::Array3d a = (kBoxMin - from).array() / ray.array();
  const Eigen::Array3d b = (kBoxMax - from).array() / ray.array();
  const double enter = a.min(b).maxCoeff();
  return enter > 0 && enter < a.max(b).minCoeff() ? enter : std::numeric_limits<double>::infinity();
}

double rangeOfHall(const Vector3d& from, const Vector3d& ray) {
  const Eigen::Array3d a = (kHallMin - from).array() / ray.array();
  const Eigen::Array3d b = (kHallMax - from).array() / ray.array();
  return a.max(b).minCoeff();
}

/// Lidar scans of the hall, from the left and from the right of the box in turn.
class Scanner {
 public:
  void scan(Box box, MapBuilder& map) {
    left_ = !left_;
    const double z = 0.9 + 0.1 * random_.normal();
    const double y = (left_ ? 1.3 : -1.3) + 0.1 * random_.normal();
    const Vector3d sensor(0.013, y, z);
    Centroids hits;
    for (double azimuth = -0.6; azimuth < 0.6; azimuth += 0.011) {
      for (double elevation = -0.6; elevation < 0.2; elevation += 0.011) {
        const Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                           std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        double range = rangeOfHall(sensor, ray);
        if (box == Box::kThere) range = std::min(range, rangeOfBox(sensor, ray));
        hits.push_back(sensor + (range + 0.01 * random_.normal()) * ray);
      }
    }
    map.insert(hits, sensor);
  }

  void scan(int count, Box box, MapBuilder& map) {
    for (int i = 0; i < count; ++i) scan(box, map);
  }

 private:
  Random random_{31};
  bool left_ = false;
};

MapBuilder mapThatClearsAfter(int scans) {
  MapConfig config;
  config.clear_after = scans;
  return MapBuilder(kSize, config, EdgeConfig{}, 1);
}

/// Voxels inside the box, clear of the floor that stays.
size_t voxelsInBox(const Voxels& voxels) {
  const Vector3d margin(kSize, kSize, 2 * kSize);
  size_t count = 0;
  for (const VoxelIndex& v : voxels) {
    const Vector3d centre = voxelCentre(v, kSize);
    const bool inside = (centre.array() > (kBoxMin - margin).array()).all() &&
                        (centre.array() < (kBoxMax + margin).array()).all();
    count += inside && centre.z() > kBoxMin.z() + 2 * kSize ? 1 : 0;
  }
  return count;
}

size_t voxelsInBox(const MapBuilder& map) { return voxelsInBox(voxelsOf(map.hitVoxels())); }

class SeeThrough : public testing::Test {
 protected:
  void scan(int count, Box box) { scanner_.scan(count, box, map_); }

  MapBuilder map_ = mapThatClearsAfter(kClearAfter);
  Scanner scanner_;
};

TEST_F(SeeThrough, AThingTakenAwayLeavesTheMap) {
  scan(6, Box::kThere);
  EXPECT_LT(200U, voxelsInBox(map_));
  EXPECT_LT(50U, voxelsInBox(voxelsOf(map_.edgeVoxels())));
  scan(30, Box::kGone);
  EXPECT_EQ(0U, voxelsInBox(map_));
  EXPECT_EQ(0U, voxelsInBox(voxelsOf(map_.edgeVoxels())));
}

TEST_F(SeeThrough, NothingLeavesByDefault) {
  map_ = mapThatClearsAfter(MapConfig{}.clear_after);
  scan(6, Box::kThere);
  const size_t before = voxelsInBox(map_);
  scan(30, Box::kGone);
  EXPECT_EQ(before, voxelsInBox(map_));
  EXPECT_EQ(0U, map_.clearedVoxels());
}

TEST_F(SeeThrough, WhatStandsStillStays) {
  MapBuilder map = mapThatClearsAfter(kClearAfter);
  MapBuilder untouched = mapThatClearsAfter(0);
  for (MapBuilder* each : {&map, &untouched}) Scanner().scan(40, Box::kThere, *each);
  const auto voxels = static_cast<double>(untouched.hitVoxels().voxelCount());
  EXPECT_LT(static_cast<double>(map.clearedVoxels()), 1e-3 * voxels);
}

TEST_F(SeeThrough, AHitStartsTheCountAnew) {
  map_ = mapThatClearsAfter(6);
  scan(6, Box::kThere);
  const size_t before = voxelsInBox(map_);
  for (int i = 0; i < 10; ++i) {
    scan(4, Box::kGone);
    scan(2, Box::kThere);
  }
  EXPECT_LT(before * 9 / 10, voxelsInBox(map_));
}

TEST_F(SeeThrough, AllLevelsAgree) {
  scan(6, Box::kThere);
  scan(6, Box::kGone);
  map_.label();
  ASSERT_LT(100U, map_.clearedVoxels());
  for (int l = 1; l < map_.levels(); ++l) {
    Voxels expected;
    if (l == 1) {
      const MomentLevel& moments = map_.moments();
      for (uint32_t slot = 0; slot < moments.size(); ++slot) {
        if (moments.cell(slot).hits > 0) expected.push_back(moments.voxel(slot));
      }
    } else {
      expected = voxelsOf(map_.matchMap().occupied(l - 1));
      for (VoxelIndex& v : expected) v = coarser(v, 1);
    }
    EXPECT_TRUE(sameVoxels(sorted(expected), voxelsOf(map_.matchMap().occupied(l))))
        << "level " << l;
  }
  map_.hitVoxels().forEach(
      [&](const VoxelIndex& v) { EXPECT_TRUE(map_.matchMap().occupied(1).test(coarser(v, 1))); });
}

TEST_F(SeeThrough, LabelsAreThoseOfWhatIsLeft) {
  scan(6, Box::kThere);
  scan(5, Box::kGone);
  map_.label();
  ASSERT_LT(100U, map_.clearedVoxels());
  EXPECT_TRUE(sameVoxels(labelledAtOnce(voxelsOf(map_.hitVoxels())), voxelsOf(map_.edgeVoxels())));
  const SurfaceLevel& surfaces = map_.matchMap().surfaces();
  for (const VoxelIndex& v : voxelsOf(map_.edgeVoxels())) {
    EXPECT_LT(0, map_.moments().cell(surfaces.slotOf(coarser(v, 1))).edge_children);
  }
}

TEST_F(SeeThrough, ComingAndGoingTakesNoMemory) {
  size_t bytes = 0;
  for (int round = 0; round < 12; ++round) {
    scan(3, Box::kThere);
    scan(8, Box::kGone);
    if (round == 5) bytes = map_.bytes();
  }
  EXPECT_LT(2000U, map_.clearedVoxels());
  EXPECT_LE(static_cast<double>(map_.bytes()), 1.02 * static_cast<double>(bytes));
}

TEST_F(SeeThrough, MatchingSeesOnlyWhatIsLeft) {
  scan(6, Box::kThere);
  scan(30, Box::kGone);
  map_.label();
  map_.prepareAll();
  const Eigen::Vector3f front = Vector3d(kBoxMin.x(), 0, -0.1).cast<float>();
  const SurfaceLevel& level = map_.matchMap().surfaces();
  EXPECT_EQ(0U, level.around(level.voxelOf(front), true).count);
}

TEST_F(SeeThrough, ClearForgetsTheCount) {
  scan(3, Box::kThere);
  scan(6, Box::kGone);
  EXPECT_LT(0U, map_.clearedVoxels());
  map_.clear();
  EXPECT_EQ(0U, map_.clearedVoxels());
}

}  // namespace
}  // namespace edgevox::test
