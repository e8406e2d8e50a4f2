// SPDX-License-Identifier: BSD-3-Clause
#include "sim/scanner.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <stdexcept>

#include "sim/worlds.hpp"

namespace edgevox::sim {
namespace {

using Eigen::Vector3d;

bool sameBytes(const Scan& a, const Scan& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0;
  };
  return a.stamp == b.stamp && same(a.points, b.points) && same(a.times, b.times) &&
         same(a.intensities, b.intensities) && same(a.rings, b.rings);
}

Sensor exactSensor(const char* name) {
  Sensor sensor = makeSensor(name);
  sensor.noise = 0.0;
  sensor.dropout = 0.0;
  return sensor;
}

double surfaceDistance(const World& world, const Vector3d& point) {
  return std::abs(world.clearance(point, 1.0));
}

class ScannerTest : public ::testing::Test {
 protected:
  World world_ = makeWorld(WorldName::Building, 1);
  Trajectory path_ = makeTrajectory(WorldName::Building);
};

TEST_F(ScannerTest, SameSeedSameBytesOnAnyNumberOfThreads) {
  const Sensor sensor = makeSensor("16");
  const auto alone = simulateSweeps(world_, path_, sensor, 40, 5, 7, 1);
  const auto shared = simulateSweeps(world_, path_, sensor, 40, 5, 7, 3);
  ASSERT_EQ(alone.size(), 5u);
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_TRUE(sameBytes(alone[i], shared[i]));
    EXPECT_TRUE(sameBytes(alone[i], simulateSweep(world_, path_, sensor, 40 + int(i), 7)));
  }
  EXPECT_FALSE(sameBytes(alone[0], simulateSweep(world_, path_, sensor, 40, 8)));
  EXPECT_FALSE(sameBytes(alone[0], alone[1]));
}

TEST_F(ScannerTest, ExactPointsLieOnSurfacesAtTheirOwnTimes) {
  for (const char* name : {"16", "32", "64"}) {
    const Sensor sensor = exactSensor(name);
    const int count = countSweeps(path_, sensor);
    for (const int sweep : {0, count / 4, count / 2, count - 1}) {
      const Scan scan = simulateSweep(world_, path_, sensor, sweep, 1);
      EXPECT_GT(scan.size(), sensor.elevations.size() * sensor.columns * 8 / 10);
      double worst = 0.0;
      for (const Vector3d& point : pointsInWorld(scan, path_)) {
        worst = std::max(worst, surfaceDistance(world_, point));
      }
      EXPECT_LT(worst, 1e-4) << name << " sweep " << sweep;
    }
  }
}

TEST_F(ScannerTest, MotionDuringTheSweepMovesThePoints) {
  const Scan scan = simulateSweep(world_, path_, exactSensor("32"), 100, 1);
  const Eigen::Isometry3d T_world_sensor = path_.poseAt(scan.stamp);
  double sum = 0.0;
  for (const Eigen::Vector3f& point : scan.points) {
    sum += surfaceDistance(world_, T_world_sensor * point.cast<double>());
  }
  EXPECT_GT(sum / static_cast<double>(scan.size()), 0.01);
}

TEST_F(ScannerTest, TimesRingsAndLimitsHold) {
  Sensor sensor = makeSensor("32");
  sensor.max_range = 8.0;
  const Scan scan = simulateSweep(world_, path_, sensor, 30, 1);
  EXPECT_DOUBLE_EQ(scan.stamp, 3.0);
  ASSERT_EQ(scan.times.size(), scan.size());
  ASSERT_EQ(scan.rings.size(), scan.size());
  ASSERT_EQ(scan.intensities.size(), scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Vector3d point = scan.points[i].cast<double>();
    ASSERT_GE(point.norm(), sensor.min_range - 1e-6);
    ASSERT_LE(point.norm(), sensor.max_range + 1e-6);
    ASSERT_NEAR(std::asin(point.z() / point.norm()), sensor.elevations[scan.rings[i]], 1e-5);
    ASSERT_GE(scan.times[i], i > 0 ? scan.times[i - 1] : 0.0f);
    ASSERT_LT(scan.times[i], sensor.period);
    ASSERT_GE(scan.intensities[i], 0.0f);
    ASSERT_LE(scan.intensities[i], 255.0f);
    const double turn = std::atan2(-point.y(), -point.x()) / (2.0 * M_PI);
    const double error = std::remainder(turn - scan.times[i] / sensor.period, 1.0);
    ASSERT_NEAR(error, 0.0, 1e-5);
  }
}

TEST_F(ScannerTest, NoiseAndDropoutsMatchTheSensor) {
  Sensor exact = exactSensor("32");
  Sensor noisy = exact;
  noisy.noise = 0.01;
  const Scan clean = simulateSweep(world_, path_, exact, 200, 3);
  const Scan rough = simulateSweep(world_, path_, noisy, 200, 3);
  ASSERT_EQ(clean.size(), rough.size());
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < clean.size(); ++i) {
    const double error = rough.points[i].norm() - clean.points[i].norm();
    sum += error;
    squares += error * error;
  }
  const auto count = static_cast<double>(clean.size());
  EXPECT_NEAR(sum / count, 0.0, 3e-4);
  EXPECT_NEAR(std::sqrt(squares / count), 0.01, 3e-4);
  exact.dropout = 0.02;
  const Scan thinned = simulateSweep(world_, path_, exact, 200, 3);
  EXPECT_NEAR(1.0 - static_cast<double>(thinned.size()) / count, 0.02, 0.004);
}

TEST_F(ScannerTest, TerrestrialScannerStandsStill) {
  Sensor sensor = exactSensor("scanner");
  sensor.columns /= 8;
  const Trajectory survey = makeTrajectory(WorldName::Building, sensor);
  ASSERT_EQ(countSweeps(survey, sensor), 12);
  const Scan scan = simulateSweep(world_, survey, sensor, 5, 1);
  EXPECT_GT(scan.size(), 90000u);
  for (const float time : scan.times) ASSERT_EQ(time, 0.0f);
  for (const Vector3d& point : pointsInWorld(scan, survey)) {
    ASSERT_LT(surfaceDistance(world_, point), 1e-4);
  }
}

TEST_F(ScannerTest, EveryPlaceOfEveryPathSeesPlenty) {
  Sensor sensor = exactSensor("16");
  sensor.columns /= 10;
  const auto rays = sensor.elevations.size() * sensor.columns;
  for (const WorldName name : {WorldName::Building, WorldName::Street, WorldName::Corridor}) {
    const World world = makeWorld(name, 2);
    const Trajectory path = makeTrajectory(name);
    for (int sweep = 0; sweep < countSweeps(path, sensor); sweep += 5) {
      ASSERT_GT(simulateSweep(world, path, sensor, sweep, 1).size(), rays / 2) << "sweep " << sweep;
    }
  }
}

TEST(Sensor, TablesMatchTheModels) {
  const auto degrees = [](double radians) { return radians * 180.0 / M_PI; };
  const Sensor beams64 = makeSensor("64");
  EXPECT_EQ(beams64.elevations.size(), 64u);
  EXPECT_NEAR(degrees(beams64.elevations.front()), -24.8, 1e-9);
  EXPECT_NEAR(degrees(beams64.elevations.back()), 2.0, 1e-9);
  EXPECT_EQ(makeSensor("32").columns, 1024);
  EXPECT_EQ(makeSensor("16").elevations.size(), 16u);
  const Sensor scanner = makeSensor("scanner");
  EXPECT_TRUE(scanner.standing);
  EXPECT_EQ(scanner.columns, 1440);
  EXPECT_NEAR(degrees(scanner.elevations[1] - scanner.elevations[0]), 0.25, 1e-9);
  EXPECT_THROW(makeSensor("17"), std::invalid_argument);
}

}  // namespace
}  // namespace edgevox::sim
