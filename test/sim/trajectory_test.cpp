// SPDX-License-Identifier: BSD-3-Clause
#include "sim/trajectory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "sim/scanner.hpp"
#include "sim/worlds.hpp"

namespace edgevox::sim {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 0.01;  // s

double angleBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

struct Limits {
  WorldName name;
  double speed;         // m/s
  double acceleration;  // m/s^2
  double turn;          // rad/s
};

class PathTest : public ::testing::TestWithParam<Limits> {};

TEST_P(PathTest, IsContinuousAndBounded) {
  const Trajectory path = makeTrajectory(GetParam().name);
  double fastest = 0.0;
  for (double t = kStep; t + kStep < path.duration(); t += kStep) {
    const Eigen::Isometry3d before = path.poseAt(t - kStep);
    const Eigen::Isometry3d now = path.poseAt(t);
    const Eigen::Isometry3d after = path.poseAt(t + kStep);
    const Vector3d velocity = (after.translation() - before.translation()) / (2.0 * kStep);
    const Vector3d acceleration =
        (after.translation() - 2.0 * now.translation() + before.translation()) / (kStep * kStep);
    ASSERT_LT(velocity.norm(), GetParam().speed) << "at " << t << " s";
    ASSERT_LT(acceleration.norm(), GetParam().acceleration) << "at " << t << " s";
    ASSERT_LT(angleBetween(now, after) / kStep, GetParam().turn) << "at " << t << " s";
    ASSERT_NEAR(now.linear().determinant(), 1.0, 1e-12);
    fastest = std::max(fastest, velocity.norm());
  }
  EXPECT_GT(fastest, 0.8 * GetParam().speed);
}

TEST_P(PathTest, StandsStillAtBothEnds) {
  const Trajectory path = makeTrajectory(GetParam().name);
  for (double t = 0.0; t <= 1.0; t += 0.1) {
    EXPECT_TRUE(path.poseAt(t).isApprox(path.poseAt(0.0), 1e-12));
    EXPECT_TRUE(path.poseAt(path.duration() - t).isApprox(path.poseAt(path.duration()), 1e-12));
  }
  EXPECT_TRUE(path.poseAt(-5.0).isApprox(path.poseAt(0.0)));
  EXPECT_TRUE(path.poseAt(path.duration() + 5.0).isApprox(path.poseAt(path.duration())));
  EXPECT_GT((path.poseAt(4.0).translation() - path.poseAt(0.0).translation()).norm(), 1.0);
}

// The sensor, and a body below it down to knee height, keep clear of every solid.
TEST_P(PathTest, KeepsClearOfSolids) {
  const Trajectory path = makeTrajectory(GetParam().name);
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const World world = makeWorld(GetParam().name, seed);
    for (double t = 0.0; t < path.duration(); t += 0.05) {
      const Vector3d position = path.poseAt(t).translation();
      ASSERT_GT(world.clearance(position, 1.0), 0.35) << "seed " << seed << ", " << t << " s";
      for (const double below : {0.3, 0.6, 0.9}) {
        ASSERT_GT(world.clearance(position - Vector3d(0.0, 0.0, below), 1.0), 0.25)
            << "seed " << seed << ", " << t << " s, " << below << " m below";
      }
    }
  }
}

TEST_P(PathTest, SensorFacesForward) {
  const Trajectory path = makeTrajectory(GetParam().name);
  double along = 0.0;
  double length = 0.0;
  for (double t = 0.0; t < path.duration(); t += 0.1) {
    Vector3d way = path.poseAt(t + 0.1).translation() - path.poseAt(t).translation();
    way.z() = 0.0;
    along += way.dot(path.poseAt(t + 0.05).linear().col(0));
    length += way.norm();
  }
  EXPECT_GT(along, 0.95 * length);
}

INSTANTIATE_TEST_SUITE_P(Worlds, PathTest,
                         ::testing::Values(Limits{WorldName::Building, 1.4, 4.0, 1.5},
                                           Limits{WorldName::Street, 8.2, 6.0, 0.9},
                                           Limits{WorldName::Corridor, 1.4, 4.0, 1.5},
                                           Limits{WorldName::City, 8.2, 6.0, 0.9}));

TEST(Trajectory, LoopsClose) {
  for (const WorldName name : {WorldName::Building, WorldName::Street}) {
    const Trajectory path = makeTrajectory(name);
    EXPECT_TRUE(path.poseAt(0.0).isApprox(path.poseAt(path.duration()), 1e-9));
    EXPECT_GE(path.duration(), 60.0);
    EXPECT_LE(path.duration(), 90.0);
  }
}

// So that a bag can be played again and again: the sweeps fill the path, and the last of them sees
// what the first one sees, from the same place.
TEST(Trajectory, RoundsJoinWithoutAJump) {
  for (const WorldName name : {WorldName::Building, WorldName::Street}) {
    for (const char* lines : {"16", "32", "64"}) {
      const Sensor sensor = makeSensor(lines);
      const Trajectory path = makeTrajectory(name, sensor);
      const double last = (countSweeps(path, sensor) - 1) * sensor.period;
      EXPECT_NEAR(last + sensor.period, path.duration(), 1e-9);
      for (const double t : {0.0, 0.5 * sensor.period, sensor.period}) {
        EXPECT_TRUE(path.poseAt(last + t).isApprox(path.poseAt(t), 1e-12));
      }
    }
  }
}

// The README's figures and the benchmarks belong to these paths.
TEST(Trajectory, PathsAreTheOnesThatWereMeasured) {
  const Trajectory walk = makeTrajectory(WorldName::Building);
  EXPECT_DOUBLE_EQ(walk.duration(), 76.0);
  const auto at = [](const Trajectory& path, double t) -> Vector3d {
    return path.poseAt(t).translation();
  };
  constexpr double kExact = 1e-11;
  EXPECT_TRUE(at(walk, 0.0).isApprox(Vector3d(5.0, 8.0, 1.4), kExact));
  EXPECT_TRUE(at(walk, 20.0).isApprox(Vector3d(20.197355005189, 7.999985668849, 1.412), kExact));
  EXPECT_TRUE(
      at(walk, 40.0).isApprox(Vector3d(16.499384573940, 6.925922727836, 4.412000000000), kExact));
  EXPECT_TRUE(
      at(walk, 60.0).isApprox(Vector3d(2.350000388992, 9.856303339089, 3.866710664663), kExact));
  const Trajectory drive = makeTrajectory(WorldName::Street);
  EXPECT_DOUBLE_EQ(drive.duration(), 81.6);
  EXPECT_TRUE(at(drive, 40.0).isApprox(Vector3d(13.598236678765, 55.000011033921, 1.808), kExact));
  const Trajectory corridor = makeTrajectory(WorldName::Corridor);
  EXPECT_DOUBLE_EQ(corridor.duration(), 43.0);
  EXPECT_TRUE(
      at(corridor, 40.0).isApprox(Vector3d(33.616858407678, 2.445368324302, 1.412), kExact));
}

TEST(Trajectory, LongStreetIsDrivenOnceAround) {
  constexpr double kLength = 1000.0;
  const Trajectory path = makeTrajectory(WorldName::Street, kLength);
  const World world = makeWorld(WorldName::Street, 3, kLength);
  double way = 0.0;
  Vector3d before = path.poseAt(0.0).translation();
  for (double t = 0.5; t < path.duration(); t += 0.5) {
    const Vector3d at = path.poseAt(t).translation();
    way += (at - before).norm();
    before = at;
    ASSERT_GE(world.clearance(at, 0.5), 0.35) << t;
  }
  EXPECT_NEAR(way, kLength, 0.02 * kLength);
  EXPECT_LT((before - path.poseAt(0.0).translation()).norm(), 0.1);
  EXPECT_GT(world.solids().size(), 1.7 * makeWorld(WorldName::Street, 3).solids().size());
  EXPECT_NEAR(world.bounds().max.x(), 75.0 + 60.0 + 45.0, 1e-9);
}

TEST(Trajectory, BuildingPathClimbsToTheUpperStorey) {
  const Trajectory path = makeTrajectory(WorldName::Building);
  const double height = sensorHeight(WorldName::Building);
  double highest = 0.0;
  double lowest = 10.0;
  for (double t = 0.0; t < path.duration(); t += 0.1) {
    highest = std::max(highest, path.poseAt(t).translation().z());
    lowest = std::min(lowest, path.poseAt(t).translation().z());
  }
  EXPECT_NEAR(highest, 3.0 + height, 0.05);
  EXPECT_NEAR(lowest, height, 0.05);
}

TEST(Trajectory, StationsAreLevelAndHold) {
  const Trajectory path = makeTrajectory(WorldName::Building);
  const Trajectory survey = path.stations(12, 2.0);
  EXPECT_DOUBLE_EQ(survey.duration(), 24.0);
  for (int i = 0; i < 12; ++i) {
    const Eigen::Isometry3d pose = survey.poseAt(2.0 * i);
    EXPECT_TRUE(pose.isApprox(survey.poseAt(2.0 * i + 1.99)));
    EXPECT_TRUE(pose.linear().col(2).isApprox(Vector3d::UnitZ()));
    if (i > 0) {
      EXPECT_GT((pose.translation() - survey.poseAt(2.0 * i - 1.0).translation()).norm(), 1.0);
    }
  }
}

TEST(Trajectory, RefusesBadInput) {
  const std::vector<Waypoint> line = {{{0.0, 0.0, 0.0}}, {{5.0, 0.0, 0.0}}};
  Gait still;
  still.speed = 0.0;
  EXPECT_THROW(Trajectory({line.front()}, Gait{}), std::invalid_argument);
  EXPECT_THROW(Trajectory(line, still), std::invalid_argument);
  EXPECT_THROW(Trajectory(line, Gait{}).stations(0, 1.0), std::invalid_argument);
  EXPECT_THROW(parseWorldName("moon"), std::invalid_argument);
}

}  // namespace
}  // namespace edgevox::sim
