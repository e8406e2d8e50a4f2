// SPDX-License-Identifier: BSD-3-Clause
#include "sim/scanner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "sim/worlds.hpp"
#include "support/sweeps.hpp"

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

// A board 0.7 m before the origin, until it is taken away.
Movers boardUntil(double end) {
  Mover board;
  addBox(board.parts, {}, {0.7, -0.5, -0.5}, {0.75, 0.5, 0.5}, 1.0);
  board.line = {Vector3d::Zero()};
  board.end = end;
  return {board};
}

TEST(Scanner, AMoverHidesWhatIsBehindItAsLongAsItIsThere) {
  const World room = test::furnishedRoom();
  const Trajectory path({{{0.0, 0.0, 0.0}}, {{1.0, 0.0, 0.0}}}, Gait{});  // at rest for a second
  const Sensor sensor = exactSensor("32");
  const Scan bare = simulateSweep(room, path, sensor, 0, 1);
  const double gone = 0.5 * sensor.period;  // when the head, which starts backwards, looks ahead
  const Scan scan = simulateSweep(room, path, sensor, 0, 1, boardUntil(gone));
  ASSERT_EQ(scan.size(), bare.size());
  int hidden = 0;
  int seen_again = 0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3f& was = bare.points[i];
    const float aside = std::max(std::abs(was.y()), std::abs(was.z()));
    const bool behind = was.x() > 0.7f && aside < 5.0f / 7.0f * was.x();
    if (behind && static_cast<double>(scan.times[i]) < gone) {
      ++hidden;
      ASSERT_NEAR(scan.points[i].x(), 0.7, 1e-4);
      ASSERT_NEAR(scan.intensities[i], 255.0 * 0.7 / scan.points[i].norm(), 0.51);
    } else {
      seen_again += behind ? 1 : 0;
      ASSERT_EQ(scan.points[i], was);
    }
  }
  EXPECT_GT(hidden, 1000);
  EXPECT_GT(seen_again, 1000);
  EXPECT_TRUE(sameBytes(bare, simulateSweep(room, path, sensor, 0, 1, boardUntil(0.0))));
}

TEST_F(ScannerTest, AMoverBehindAWallIsNotSeen) {
  Mover outside;
  addBox(outside.parts, {}, {-1.0, -1.0, 0.0}, {1.0, 1.0, 1.0}, 0.5);
  outside.line = {{9.5, 1.5, 0.0}};  // another room
  const Sensor sensor = makeSensor("16");
  EXPECT_TRUE(sameBytes(simulateSweep(world_, path_, sensor, 0, 1),
                        simulateSweep(world_, path_, sensor, 0, 1, {outside})));
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
  ASSERT_EQ(countSweeps(survey, sensor), 36);
  const Scan scan = simulateSweep(world_, survey, sensor, 5, 1);
  EXPECT_GT(scan.size(), 90000u);
  for (const float time : scan.times) ASSERT_EQ(time, 0.0f);
  for (const Vector3d& point : pointsInWorld(scan, survey)) {
    ASSERT_LT(surfaceDistance(world_, point), 1e-4);
  }
}

TEST_F(ScannerTest, CityIsSeenFrom13Stations) {
  const World city = makeWorld(WorldName::City, 3);
  const Aabb bounds = city.bounds();
  EXPECT_GE(bounds.max.x() - bounds.min.x(), 800.0);
  EXPECT_GE(bounds.max.y() - bounds.min.y(), 800.0);
  Sensor sensor = makeSensor("fine-scanner");
  EXPECT_EQ(sensor.elevations.size() * sensor.columns, 22509000u);
  sensor.columns /= 100;
  const Trajectory survey = makeTrajectory(WorldName::City, sensor);
  ASSERT_EQ(countSweeps(survey, sensor), 13);
  for (int station = 0; station < 13; ++station) {
    const Eigen::Vector3d at = survey.poseAt(station * sensor.period).translation();
    EXPECT_GT(city.clearance(at, 2.0), 1.0) << station;
    if (station % 6 != 0) continue;
    const Scan scan = simulateSweep(city, survey, sensor, station, 1);
    EXPECT_GT(scan.size(), 110000u) << station;
    double farthest = 0.0;
    for (const Eigen::Vector3f& point : scan.points) {
      farthest = std::max(farthest, static_cast<double>(point.norm()));
    }
    EXPECT_GT(farthest, 250.0) << station;
  }
}

TEST_F(ScannerTest, EveryPlaceOfEveryPathSeesPlenty) {
  Sensor sensor = exactSensor("16");
  sensor.columns /= 10;
  const auto rays = sensor.elevations.size() * sensor.columns;
  for (const WorldName name :
       {WorldName::Building, WorldName::Street, WorldName::Corridor, WorldName::City}) {
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
