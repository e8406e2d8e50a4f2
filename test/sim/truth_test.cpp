// SPDX-License-Identifier: BSD-3-Clause
#include "sim/truth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/parts.hpp"
#include "sim/random.hpp"
#include "sim/worlds.hpp"

namespace edgevox::sim {
namespace {

using Eigen::Vector3d;

constexpr double kHalfPi = M_PI / 2.0;

double lengthOf(const std::vector<Crease>& creases, CreaseKind kind) {
  double length = 0.0;
  for (const Crease& crease : creases) {
    if (crease.kind == kind) length += (crease.end - crease.start).norm();
  }
  return length;
}

double distanceTo(const Crease& crease, const Vector3d& point) {
  const Vector3d way = crease.end - crease.start;
  const double u = (point - crease.start).dot(way) / way.squaredNorm();
  return (crease.start + std::clamp(u, 0.0, 1.0) * way - point).norm();
}

// The share of a small ball around the point that is solid, by random sampling.
double solidShare(const World& world, const Vector3d& centre, double radius, int samples,
                  Random& random) {
  int solid = 0;
  for (int drawn = 0; drawn < samples;) {
    const Vector3d offset{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
                          random.uniform(-1.0, 1.0)};
    if (offset.norm() > 1.0) continue;
    ++drawn;
    if (world.contains(centre + radius * offset)) ++solid;
  }
  return static_cast<double>(solid) / samples;
}

TEST(Truth, SingleBoxHasTwelveEdgesAndEightCorners) {
  Solids solids;
  addTurnedBox(solids, {1.0, 2.0, 3.0}, {1.0, 2.0, 3.0}, Eigen::Quaterniond(0.9, 0.2, -0.3, 0.4),
               0.5);
  const auto creases = findCreases(World(solids));
  ASSERT_EQ(creases.size(), 12u);
  for (const Crease& crease : creases) {
    EXPECT_EQ(crease.kind, CreaseKind::Convex);
    EXPECT_NEAR(crease.solid_angle, kHalfPi, 1e-3);
  }
  EXPECT_NEAR(lengthOf(creases, CreaseKind::Convex), 24.0, 1e-6);
  const auto corners = findCorners(creases);
  ASSERT_EQ(corners.size(), 8u);
  for (const Corner& corner : corners) EXPECT_EQ(corner.creases, 3);
}

TEST(Truth, BoxOnFloorMeetsItInConcaveCreases) {
  Solids solids;
  addBox(solids, {}, {-5.0, -5.0, -1.0}, {5.0, 5.0, 0.0}, 0.5);
  addBox(solids, {0.3, 0.2, 0.0, 0.4}, {-1.0, -0.5, 0.0}, {1.0, 0.5, 0.7}, 0.5);
  const auto creases = findCreases(World(solids));
  EXPECT_EQ(creases.size(), 12u + 12u);
  EXPECT_NEAR(lengthOf(creases, CreaseKind::Concave), 6.0, 1e-4);
  EXPECT_NEAR(lengthOf(creases, CreaseKind::Convex), 84.0 + 6.0 + 4 * 0.7, 1e-4);
  for (const Crease& crease : creases) {
    const double expected = crease.kind == CreaseKind::Concave ? 3 * kHalfPi : kHalfPi;
    EXPECT_NEAR(crease.solid_angle, expected, 1e-3);
  }
  EXPECT_EQ(findCorners(creases).size(), 16u);
}

TEST(Truth, FlushAndBuriedSolidsLeaveNoTrace) {
  Solids solids;
  addBox(solids, {}, {0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}, 0.5);
  addBox(solids, {}, {1.0, 0.0, 0.0}, {2.0, 1.0, 1.0}, 0.5);
  addBox(solids, {}, {0.5, 0.2, 0.3}, {1.7, 0.8, 0.6}, 0.5);
  const auto creases = findCreases(World(solids));
  EXPECT_EQ(creases.size(), 12u);
  EXPECT_NEAR(lengthOf(creases, CreaseKind::Convex), 4 * (2.0 + 1.0 + 1.0), 1e-6);
  EXPECT_EQ(findCorners(creases).size(), 8u);
}

TEST(Truth, CrossedBoxesMeetInTheirFaces) {
  Solids solids;  // a bar through a slab
  addBox(solids, {}, {-1.0, -1.0, -0.1}, {1.0, 1.0, 0.1}, 0.5);
  addBox(solids, {}, {-0.2, -0.3, -1.0}, {0.2, 0.3, 1.0}, 0.5);
  const auto creases = findCreases(World(solids));
  EXPECT_NEAR(lengthOf(creases, CreaseKind::Concave), 2 * 2.0, 1e-3);
  EXPECT_NEAR(lengthOf(creases, CreaseKind::Convex), 16.8 + 2 * 2.0 + 4 * 1.8, 1e-3);
  EXPECT_EQ(findCorners(creases).size(), 8u + 8u + 8u);
}

TEST(Truth, SlopeOnFloorKeepsItsAngle) {
  Solids solids;
  addBox(solids, {}, {-5.0, -5.0, -1.0}, {5.0, 5.0, 0.0}, 0.5);
  const Eigen::Quaterniond tilt(Eigen::AngleAxisd(M_PI / 6.0, Vector3d::UnitY()));
  addTurnedBox(solids, {0.0, 0.0, 0.0}, {3.0, 2.0, 0.4}, tilt, 0.5);
  const auto creases = findCreases(World(solids));
  const auto count = [&](double degrees) {
    return std::count_if(creases.begin(), creases.end(), [&](const Crease& crease) {
      return std::abs(crease.solid_angle * 180.0 / M_PI - degrees) < 0.1;
    });
  };
  EXPECT_EQ(count(210.0), 1);  // the upper face runs down into the floor
  EXPECT_EQ(count(330.0), 1);  // the lower face rises from it
}

TEST(Truth, DoorwayInWall) {
  Solids solids;
  addBox(solids, {}, {-1.0, -2.0, -1.0}, {6.0, 2.0, 0.0}, 0.5);
  addWall(solids, {0.0, 0.0, 5.0, 0.0, 0.2, 0.0, 2.5, {{2.0, 3.0, 0.0, 2.0}}}, 0.5);
  const auto creases = findCreases(World(solids));
  const double opening = 2 * (2.0 + 2.0 + 1.0) + 2 * 0.2;  // both faces; the lintel is concave
  const double shell = 4 * 2.5 + 2 * 5.0 + 2 * 0.2;
  const double floor = 4 * (7.0 + 4.0 + 1.0);
  EXPECT_NEAR(lengthOf(creases, CreaseKind::Convex), opening - 0.4 + shell + floor, 1e-3);
  EXPECT_NEAR(lengthOf(creases, CreaseKind::Concave), 2 * 4.0 + 4 * 0.2 + 0.4, 1e-3);
}

TEST(Truth, ColumnOnFloor) {
  Solids solids;
  addBox(solids, {}, {-2.0, -2.0, -1.0}, {2.0, 2.0, 0.0}, 0.5);
  addColumn(solids, {0.0, 0.0, 0.0}, 0.25, 2.0, 0.5);
  const auto creases = findCreases(World(solids));
  double top = 0.0;
  double foot = 0.0;
  for (const Crease& crease : creases) {
    if (!crease.rim) continue;
    EXPECT_NEAR(crease.start.head<2>().norm(), 0.25, 1e-9);
    const bool at_top = crease.start.z() > 1.0;
    EXPECT_EQ(crease.kind, at_top ? CreaseKind::Convex : CreaseKind::Concave);
    (at_top ? top : foot) += (crease.end - crease.start).norm();
  }
  EXPECT_NEAR(top, 2.0 * M_PI * 0.25, 0.02);
  EXPECT_NEAR(foot, 2.0 * M_PI * 0.25, 0.02);
  EXPECT_EQ(findCorners(creases).size(), 8u);
}

TEST(Truth, VisiblePartsEndWhereTheViewIsBlocked) {
  Solids solids;
  addBox(solids, {}, {5.0, -2.0, 0.0}, {6.0, 2.0, 1.0}, 0.5);
  addBox(solids, {}, {2.0, 0.0, -5.0}, {2.1, 5.0, 5.0}, 0.5);
  const World world(solids);
  const std::vector<Crease> edge = {{{5.0, -2.0, 1.0}, {5.0, 2.0, 1.0}, kHalfPi}};
  const auto visible = visibleCreases(world, edge, {{0.0, 0.0, 2.0}}, 20.0, 0.01);
  ASSERT_EQ(visible.size(), 1u);
  EXPECT_NEAR(visible[0].start.y(), -2.0, 0.011);
  EXPECT_NEAR(visible[0].end.y(), 0.0, 0.011);
  EXPECT_TRUE(visibleCreases(world, edge, {{0.0, 0.0, 2.0}}, 3.0, 0.01).empty());
}

class WorldTruthTest : public ::testing::TestWithParam<WorldName> {
 protected:
  World world_ = makeWorld(GetParam(), 3);
  std::vector<Crease> creases_ = findCreases(world_);
  Random random_{21};
};

// Around the middle of a crease the solid share of a small ball is the crease's share of a turn.
TEST_P(WorldTruthTest, CreasesAgreeWithTheSolidsAroundThem) {
  ASSERT_GT(creases_.size(), 100u);
  int checked = 0;
  for (std::size_t i = 0; i < creases_.size(); i += 1 + creases_.size() / 300) {
    const Crease& crease = creases_[i];
    if (crease.rim || (crease.end - crease.start).norm() < 0.01) continue;
    const Vector3d point = crease.start + 0.437 * (crease.end - crease.start);
    const double share = solidShare(world_, point, 0.001, 1500, random_);
    EXPECT_NEAR(share, crease.solid_angle / (2.0 * M_PI), 0.06) << point.transpose();
    ++checked;
  }
  EXPECT_GT(checked, 100);
}

// Wherever the surface seen from the path is not flat, a crease is at hand.
TEST_P(WorldTruthTest, NoBendIsMissed) {
  constexpr double kRadius = 0.02;  // m
  const Trajectory path = makeTrajectory(GetParam());
  int bent = 0;
  for (int i = 0; i < 8000; ++i) {
    const Vector3d eye = path.poseAt(random_.uniform(0.0, path.duration())).translation();
    const Vector3d direction =
        Vector3d{random_.normal(), random_.normal(), random_.normal()}.normalized();
    const auto hit = world_.castRay(eye, direction, 30.0);
    if (!hit) continue;
    const Vector3d point = eye + hit->range * direction;
    const double share = solidShare(world_, point, kRadius, 150, random_);
    if (std::abs(share - 0.5) < 0.18) continue;
    ++bent;
    const bool near = std::any_of(creases_.begin(), creases_.end(), [&](const Crease& crease) {
      return distanceTo(crease, point) < 1.1 * kRadius;
    });
    EXPECT_TRUE(near) << point.transpose() << ", solid share " << share;
  }
  EXPECT_GT(bent, 20);
}

INSTANTIATE_TEST_SUITE_P(Worlds, WorldTruthTest,
                         ::testing::Values(WorldName::Building, WorldName::Corridor));

}  // namespace
}  // namespace edgevox::sim
