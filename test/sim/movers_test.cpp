// SPDX-License-Identifier: BSD-3-Clause
#include "sim/movers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "sim/scanner.hpp"
#include "sim/worlds.hpp"

namespace edgevox::sim {
namespace {

using Eigen::Vector3d;

constexpr double kEnd = 76.0;  // s, of the walk through the building

Mover blockAt(std::vector<Vector3d> line) {
  Mover mover;
  addBox(mover.parts, {}, {-0.2, -0.4, 0.0}, {0.2, 0.4, 1.0}, 0.5);
  mover.line = std::move(line);
  return mover;
}

// Points all over the surface and the inside of a box.
std::vector<Vector3d> pointsOf(const Solid& box) {
  std::vector<Vector3d> points;
  for (double x = -1.0; x <= 1.0; x += 0.25) {
    for (double y = -1.0; y <= 1.0; y += 0.25) {
      for (double z = -1.0; z <= 1.0; z += 0.25) {
        points.push_back(box.T_world_solid * Vector3d(x, y, z).cwiseProduct(box.half));
      }
    }
  }
  return points;
}

TEST(Mover, WalksToAndFro) {
  Mover mover = blockAt({{1.0, 0.0, 0.0}, {3.0, 0.0, 0.0}, {3.0, 4.0, 0.0}});
  mover.speed = 2.0;
  mover.lead = 1.0;
  const auto at = [&](double time) -> Vector3d { return mover.poseAt(time).translation(); };
  EXPECT_TRUE(at(0.0).isApprox(Vector3d(2.0, 0.0, 0.0)));
  EXPECT_TRUE(at(1.0).isApprox(Vector3d(3.0, 1.0, 0.0)));
  EXPECT_TRUE(at(2.5).isApprox(Vector3d(3.0, 4.0, 0.0)));
  EXPECT_TRUE(at(3.5).isApprox(Vector3d(3.0, 2.0, 0.0)));
  EXPECT_TRUE(at(5.5).isApprox(Vector3d(1.0, 0.0, 0.0)));
  EXPECT_TRUE(at(6.0).isApprox(at(0.0)));
  EXPECT_TRUE(mover.poseAt(0.2).linear().isIdentity(1e-12));
  EXPECT_TRUE(mover.poseAt(1.0).linear().col(0).isApprox(Vector3d::UnitY()));
}

TEST(Mover, IsThereForAWhile) {
  Mover mover = blockAt({{5.0, 6.0, 7.0}});
  mover.begin = 1.0;
  mover.end = 2.0;
  EXPECT_EQ(solidsAt({mover}, 0.9).size(), 0u);
  EXPECT_EQ(solidsAt({mover}, 2.0).size(), 0u);
  const Solids there = solidsAt({mover, mover}, 1.0);
  ASSERT_EQ(there.size(), 2u);
  EXPECT_TRUE(there[0].T_world_solid.translation().isApprox(Vector3d(5.0, 6.0, 7.5)));
}

TEST(Mover, VolumeIsWhatWasOccupiedMeanwhile) {
  Mover mover = blockAt({{0.0, 0.0, 0.0}, {4.0, 0.0, 0.0}});
  mover.speed = 1.0;
  mover.begin = 1.0;
  mover.end = 3.0;
  const World all = volumeOf({mover}, 0.0, 10.0);
  for (double x = 0.81; x < 3.2; x += 0.05) {
    EXPECT_LT(all.clearance({x, 0.3, 0.5}, 1.0), 0.0) << x;
    EXPECT_NEAR(all.clearance({x, 0.6, 0.5}, 1.0), 0.2, 0.02) << x;
  }
  EXPECT_NEAR(all.clearance({0.7, 0.0, 0.5}, 1.0), 0.1, 1e-9);
  EXPECT_NEAR(all.clearance({3.4, 0.0, 0.5}, 1.0), 0.2, 1e-9);
  EXPECT_NEAR(volumeOf({mover}, 0.0, 2.0).clearance({2.4, 0.0, 0.5}, 1.0), 0.2, 1e-9);
  EXPECT_TRUE(volumeOf({mover}, 4.0, 10.0).solids().empty());
  EXPECT_TRUE(volumeOf({mover}, 3.0, 10.0).solids().empty());
  EXPECT_TRUE(volumeOf({mover}, 0.0, 0.5).solids().empty());
  EXPECT_EQ(volumeOf({blockAt({{1.0, 0.0, 0.0}})}, 0.0, 10.0).solids().size(), 1u);
}

class BuildingMoversTest : public ::testing::TestWithParam<std::uint64_t> {
 protected:
  World world_ = makeWorld(WorldName::Building, GetParam());
  Movers movers_ = makeMovers(WorldName::Building, GetParam());
};

TEST_P(BuildingMoversTest, KeepClearOfThePath) {
  const World occupied = volumeOf(movers_, 0.0, kEnd);
  const Trajectory path = makeTrajectory(WorldName::Building);
  for (double time = 0.0; time < path.duration(); time += 0.05) {
    const Vector3d position = path.poseAt(time).translation();
    ASSERT_GE(occupied.clearance(position, 1.0), 0.6) << time << " s";
    ASSERT_GE(occupied.clearance(position - Vector3d(0.0, 0.0, 0.9), 1.0), 0.6) << time << " s";
  }
}

TEST_P(BuildingMoversTest, KeepClearOfWallsAndFurniture) {
  for (double time = 0.0; time < kEnd; time += 0.25) {
    for (const Solid& solid : solidsAt(movers_, time)) {
      for (const Vector3d& point : pointsOf(solid)) {
        ASSERT_GE(world_.clearance(point, 1.0), -1e-9) << time << " s\n" << point;
        if (point.z() > 0.1) {
          ASSERT_GT(world_.clearance(point, 1.0), 0.09) << time << " s\n" << point;
        }
      }
    }
  }
}

TEST_P(BuildingMoversTest, KeepClearOfOneAnother) {
  for (const Mover& mover : movers_) {
    Movers others;
    for (const Mover& other : movers_) {
      if (&other != &mover) others.push_back(other);
    }
    for (double time = 0.0; time < kEnd; time += 0.25) {
      const World around(solidsAt(others, time));
      for (const Solid& solid : solidsAt({mover}, time)) {
        for (const Vector3d& point : pointsOf(solid)) {
          ASSERT_GT(around.clearance(point, 1.0), 0.2) << time << " s";
        }
      }
    }
  }
}

// All are hit by many rays, and where a thing was taken away many go through its place.
TEST_P(BuildingMoversTest, AreSeenAndSeenThroughAfterwards) {
  const Trajectory path = makeTrajectory(WorldName::Building);
  Sensor sensor = makeSensor("16");
  sensor.columns /= 4;
  std::vector<World> volumes;
  for (const Mover& mover : movers_) volumes.push_back(volumeOf({mover}, 0.0, kEnd));
  std::vector<int> hits(movers_.size(), 0);
  std::vector<int> through(movers_.size(), 0);
  for (int sweep = 0; sweep < countSweeps(path, sensor); sweep += 4) {
    const Scan scan = simulateSweep(world_, path, sensor, sweep, 1, movers_);
    const Vector3d origin = path.poseAt(scan.stamp).translation();
    for (const Vector3d& point : pointsInWorld(scan, path)) {
      const Vector3d ray = point - origin;
      for (std::size_t i = 0; i < movers_.size(); ++i) {
        hits[i] += point.z() > 0.1 && volumes[i].clearance(point, 1.0) < 0.02;
        through[i] += !movers_[i].isThere(scan.stamp) &&
                      volumes[i].castRay(origin, ray.normalized(), ray.norm() - 0.2).has_value();
      }
    }
  }
  for (std::size_t i = 0; i < movers_.size(); ++i) {
    EXPECT_GT(hits[i], 200) << i;
    if (movers_[i].end < kEnd) EXPECT_GT(through[i], 200) << i;
  }
}

TEST_P(BuildingMoversTest, AreTheSameForTheSameSeed) {
  const Movers again = makeMovers(WorldName::Building, GetParam());
  const Movers others = makeMovers(WorldName::Building, GetParam() + 1);
  ASSERT_EQ(again.size(), movers_.size());
  EXPECT_TRUE(again[0].poseAt(3.0).isApprox(movers_[0].poseAt(3.0), 0.0));
  EXPECT_FALSE(others[0].poseAt(3.0).isApprox(movers_[0].poseAt(3.0)));
}

INSTANTIATE_TEST_SUITE_P(Seeds, BuildingMoversTest, ::testing::Values(1, 2, 3));

TEST(Mover, AreInTheBuildingOnly) {
  EXPECT_THROW(makeMovers(WorldName::Street, 1), std::invalid_argument);
  EXPECT_THROW(makeMovers(WorldName::Corridor, 1), std::invalid_argument);
}

}  // namespace
}  // namespace edgevox::sim
