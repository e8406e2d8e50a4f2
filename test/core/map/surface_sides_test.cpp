// SPDX-License-Identifier: BSD-3-Clause
// Thin walls in a map: what is seen from one side is not matched from the other.
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>

#include "edgevox/map/map_builder.hpp"
#include "support/random.hpp"
#include "support/scans.hpp"

namespace edgevox::test {
namespace {

using Eigen::Vector3d;

MapBuilder mapOfAllVoxels() {
  MapConfig config;
  config.representation = Representation::kAll;
  return MapBuilder(kScanMapVoxel, config, EdgeConfig{}, 1);
}

/// A ceiling between two storeys, seen from above first.
struct Ceiling {
  static constexpr double kTop = 0.55;  // [m], both sides in one voxel of level 1
  static constexpr double kBottom = 0.45;

  explicit Ceiling(int scans) : map(mapOfAllVoxels()) {
    Random random(19);
    for (int scan = 0; scan < scans; ++scan) {
      const bool above = scan < scans / 2;
      Centroids centroids;
      for (int i = 0; i < 2000; ++i) {
        const double height = (above ? kTop : kBottom) + 0.005 * random.normal();
        const double x = random.uniform(-1, 1);
        centroids.push_back({x, random.uniform(-1, 1), height});
      }
      const Vector3d offset{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 0};
      map.insert(centroids, offset + (above ? kAbove : kBelow));
    }
  }

  const Vector3d kAbove{0, 0, 3.5};
  const Vector3d kBelow{0, 0, -2.5};
  MapBuilder map;
};

TEST(Sides, OfAThinSlabAreTwoSurfaces) {
  const Ceiling ceiling(8);
  const SurfaceLevel& surfaces = ceiling.map.matchMap().surfaces();
  const MomentLevel& moments = ceiling.map.moments();
  const size_t voxels = ceiling.map.matchMap().occupied(1).voxelCount();
  EXPECT_EQ(voxels, surfaces.selectedCount());
  EXPECT_EQ(2 * voxels, moments.selectedSurfaces());
  for (uint32_t slot = 0; slot < moments.size(); ++slot) {
    if (moments.cell(slot).is_back) continue;
    ASSERT_TRUE(surfaces.hasBack(slot));
    const Surface& top = surfaces.surface(slot);
    const Surface& bottom = surfaces.surface(top.back_surface);
    EXPECT_NEAR(Ceiling::kTop, static_cast<double>(top.mean.z()), 0.005);
    EXPECT_NEAR(Ceiling::kBottom, static_cast<double>(bottom.mean.z()), 0.005);
    EXPECT_EQ(8, moments.cell(slot).hits);  // of the voxel, whichever side
  }
}

TEST(Sides, PointsMatchTheirOwn) {
  const Ceiling ceiling(8);
  Random random(23);
  for (int i = 0; i < 500; ++i) {
    const double x = random.uniform(-0.9, 0.9);
    const Vector3d point{x, random.uniform(-0.9, 0.9), random.uniform(0.45, 0.55)};
    for (const bool above : {true, false}) {
      const Vector3d& sensor = above ? ceiling.kAbove : ceiling.kBelow;
      const Vector3d to_sensor = (sensor - point).normalized();
      float distance = 0.0F;
      const SurfaceLevel& level = ceiling.map.matchMap().surfaces();
      const Eigen::Vector3f at = point.cast<float>();
      const Surface* nearest = level.nearest(level.around(level.voxelOf(at), false), at,
                                             to_sensor.cast<float>(), distance);
      ASSERT_NE(nullptr, nearest);
      ASSERT_NEAR(above ? Ceiling::kTop : Ceiling::kBottom, static_cast<double>(nearest->mean.z()),
                  0.005);
    }
  }
}

TEST(Sides, ASurfaceSeenFromOneSideIsNotMatchedFromBehind) {
  Random random(29);
  MapBuilder map = mapOfAllVoxels();
  const Vector3d above(0.1, 0.2, 2.5);
  for (int scan = 0; scan < 3; ++scan) {
    Centroids floor;
    for (int i = 0; i < 4000; ++i) {
      const double x = random.uniform(-2, 2);
      floor.push_back({x, random.uniform(-2, 2), 0.5 + 0.005 * random.normal()});
    }
    map.insert(floor, above);
  }
  float distance = 0.0F;
  const Eigen::Vector3f up = Eigen::Vector3f::UnitZ();
  const Eigen::Vector3f point(0.5F, 0.5F, 0.5F);
  const SurfaceLevel& level = map.matchMap().surfaces();
  const auto around = level.around(level.voxelOf(point), false);
  EXPECT_NE(nullptr, level.nearest(around, point, up, distance));
  EXPECT_EQ(nullptr, level.nearest(around, point, -up, distance));
  EXPECT_EQ(map.matchMap().occupied(1).voxelCount(), level.slotCount());  // no back surfaces
}

}  // namespace
}  // namespace edgevox::test
