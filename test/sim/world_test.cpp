// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/random.hpp"
#include "sim/worlds.hpp"

namespace edgevox::sim {
namespace {

using Eigen::Vector3d;

Vector3d randomDirection(Random& random) {
  const Vector3d direction{random.normal(), random.normal(), random.normal()};
  return direction.normalized();
}

Vector3d randomPoint(Random& random, const Aabb& box) {
  return {random.uniform(box.min.x(), box.max.x()), random.uniform(box.min.y(), box.max.y()),
          random.uniform(box.min.z(), box.max.z())};
}

Solid randomSolid(Random& random, double spread) {
  Solid solid;
  solid.shape = random.uniform() < 0.5 ? Shape::Box : Shape::Cylinder;
  solid.half =
      Vector3d{random.uniform(0.1, 2.0), random.uniform(0.1, 2.0), random.uniform(0.1, 2.0)};
  if (solid.shape == Shape::Cylinder) solid.half.y() = solid.half.x();
  const Vector3d reach = Vector3d::Constant(spread);
  const Vector3d centre = randomPoint(random, {-reach, reach});
  const Vector3d axis = randomDirection(random);
  solid.T_world_solid =
      Eigen::Translation3d(centre) * Eigen::AngleAxisd(random.uniform(0.0, 3.0), axis);
  return solid;
}

// Walks along the ray by the distance to the solid: no intersection formula is involved.
std::optional<double> sphereTrace(const Solid& solid, const Vector3d& origin,
                                  const Vector3d& direction, double max_range) {
  double range = 0.0;
  for (int step = 0; step < 20000 && range < max_range; ++step) {
    const double distance = solid.signedDistance(origin + range * direction);
    if (distance < 1e-9) return range;
    range += distance;
  }
  return std::nullopt;
}

std::optional<Hit> castAtAll(const World& world, const Vector3d& origin, const Vector3d& direction,
                             double max_range) {
  std::optional<Hit> nearest;
  for (std::size_t i = 0; i < world.solids().size(); ++i) {
    const auto hit = world.solids()[i].castRay(origin, direction);
    if (!hit || hit->range > max_range) continue;
    if (!nearest || hit->range < nearest->range) {
      nearest = Hit{hit->range, hit->normal, static_cast<int>(i)};
    }
  }
  return nearest;
}

TEST(Solid, RayEntersBoxAtItsFace) {
  Solid box;
  box.half = Vector3d(1.0, 2.0, 3.0);
  const auto hit = box.castRay({-5.0, 1.0, 1.0}, Vector3d::UnitX());
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(hit->range, 4.0);
  EXPECT_EQ(hit->normal, Vector3d(-1.0, 0.0, 0.0));
  EXPECT_FALSE(box.castRay({-5.0, 2.1, 1.0}, Vector3d::UnitX()));
  EXPECT_FALSE(box.castRay({-5.0, 0.0, 0.0}, -Vector3d::UnitX()));
  EXPECT_FALSE(box.castRay({0.0, 0.0, 0.0}, Vector3d::UnitX()));
}

TEST(Solid, RayEntersCylinderAtSideAndCap) {
  Solid cylinder;
  cylinder.shape = Shape::Cylinder;
  cylinder.half = Vector3d(1.0, 1.0, 2.0);
  const auto side = cylinder.castRay({0.0, 5.0, 0.0}, -Vector3d::UnitY());
  ASSERT_TRUE(side);
  EXPECT_DOUBLE_EQ(side->range, 4.0);
  EXPECT_TRUE(side->normal.isApprox(Vector3d::UnitY()));
  const auto cap = cylinder.castRay({0.5, 0.0, 5.0}, -Vector3d::UnitZ());
  ASSERT_TRUE(cap);
  EXPECT_DOUBLE_EQ(cap->range, 3.0);
  EXPECT_EQ(cap->normal, Vector3d::UnitZ());
  EXPECT_FALSE(cylinder.castRay({1.5, 0.0, 5.0}, -Vector3d::UnitZ()));
}

TEST(Solid, CastRayAgreesWithSphereTracing) {
  Random random(11);
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const Solid solid = randomSolid(random, 1.0);
    const Vector3d origin = 6.0 * randomDirection(random);
    const Vector3d target =
        solid.T_world_solid *
        (1.2 * solid.half.cwiseProduct(
                   Vector3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}));
    if (solid.signedDistance(origin) <= 0.0) continue;
    const Vector3d direction = (target - origin).normalized();
    const auto hit = solid.castRay(origin, direction);
    const auto traced = sphereTrace(solid, origin, direction, 20.0);
    ASSERT_EQ(hit.has_value(), traced.has_value()) << "case " << i;
    if (!hit) continue;
    ++hits;
    // A grazing walk stops early by its tolerance over the sine of the grazing angle.
    const double facing = std::abs(hit->normal.dot(direction));
    ASSERT_NEAR(hit->range, *traced, 1e-8 / std::max(facing, 1e-4)) << "case " << i;
    ASSERT_LT(hit->normal.dot(direction), 0.0);
    ASSERT_GT(solid.signedDistance(origin + hit->range * direction + 1e-4 * hit->normal), 0.0);
  }
  EXPECT_GT(hits, 1500);
}

TEST(Solid, BoundsHoldTheSolidTightly) {
  Random random(12);
  for (int i = 0; i < 200; ++i) {
    const Solid solid = randomSolid(random, 5.0);
    const Aabb box = solid.aabb();
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {-1.0, 1.0}) {
        // Seen from far away along an axis, the nearest point of a convex solid is at its bound.
        Vector3d far = solid.T_world_solid.translation();
        far[axis] += sign * 1e6;
        const double bound = sign > 0.0 ? box.max[axis] : box.min[axis];
        ASSERT_NEAR(std::abs(far[axis] - bound), solid.signedDistance(far), 1e-4);
      }
    }
  }
}

TEST(World, HierarchyAgreesWithAllSolids) {
  Random random(13);
  for (const WorldName name :
       {WorldName::Building, WorldName::Street, WorldName::Corridor, WorldName::City}) {
    const World world = makeWorld(name, 5);
    const Aabb inner = world.bounds().inflated(-0.4);
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vector3d origin = randomPoint(random, inner);
      const Vector3d direction = randomDirection(random);
      const auto fast = world.castRay(origin, direction, 40.0);
      const auto slow = castAtAll(world, origin, direction, 40.0);
      ASSERT_EQ(fast.has_value(), slow.has_value());
      if (!fast) continue;
      ++hits;
      ASSERT_DOUBLE_EQ(fast->range, slow->range);
      const Vector3d end = origin + fast->range * direction;
      ASSERT_NEAR(world.solids()[fast->solid].signedDistance(end), 0.0, 1e-9);
    }
    EXPECT_GT(hits, 500);
  }
}

TEST(World, RaysAlongAxes) {
  std::vector<Solid> solids(3);
  for (int i = 0; i < 3; ++i) solids[i].T_world_solid.translation().x() = 4.0 * i;
  const World world(solids);
  for (const double y : {-0.999, 0.0, 0.5, 0.999}) {
    const auto hit = world.castRay({-3.0, y, 0.0}, Vector3d::UnitX(), 100.0);
    ASSERT_TRUE(hit) << y;
    EXPECT_DOUBLE_EQ(hit->range, 2.0);
    EXPECT_EQ(hit->solid, 0);
  }
  EXPECT_FALSE(world.castRay({-3.0, 1.001, 0.0}, Vector3d::UnitX(), 100.0));
  EXPECT_FALSE(world.castRay({-3.0, 0.0, 0.0}, Vector3d::UnitX(), 1.99));
  EXPECT_FALSE(World({}).castRay({0.0, 0.0, 0.0}, Vector3d::UnitX(), 10.0));
}

TEST(World, ManyEqualSolidsKeepTheHierarchyShallow) {
  const World world(std::vector<Solid>(5000));
  const auto hit = world.castRay({-3.0, 0.1, 0.2}, Vector3d::UnitX(), 100.0);
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(hit->range, 2.0);
}

TEST(World, PointQueriesAgreeWithAllSolids) {
  Random random(14);
  const World world = makeWorld(WorldName::Building, 5);
  std::vector<int> found;
  for (int i = 0; i < 1000; ++i) {
    const Vector3d point = randomPoint(random, world.bounds());
    double nearest = 0.7;
    std::vector<int> expected;
    const Aabb box = Aabb{point, point}.inflated(0.1);
    for (std::size_t k = 0; k < world.solids().size(); ++k) {
      nearest = std::min(nearest, world.solids()[k].signedDistance(point));
      if (world.solids()[k].aabb().overlaps(box)) expected.push_back(static_cast<int>(k));
    }
    const double clearance = world.clearance(point, 0.7);
    ASSERT_DOUBLE_EQ(std::max(clearance, 0.0), std::max(nearest, 0.0));
    ASSERT_EQ(clearance < 0.0, nearest < 0.0);
    ASSERT_EQ(world.contains(point), nearest <= 0.0);
    world.findSolids(box, found);
    ASSERT_EQ(found, expected);
  }
}

}  // namespace
}  // namespace edgevox::sim
