// SPDX-License-Identifier: BSD-3-Clause
// How fast a sensor may move and turn: mapper/max_speed, mapper/max_turn.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "edgevox/mapping/mapper.hpp"
#include "support/sweeps.hpp"

namespace edgevox::test {
namespace {

constexpr double kPeriod = 0.1;  // [s]
constexpr double kSpeed = 35.0;  // [m/s]

/// Sweeps of a car that drives along a street at kSpeed all the time.
std::vector<Sweep> drive(double from, bool with_times) {
  constexpr double kStreet = 2400.0;  // [m]
  constexpr int kCount = 8;
  const sim::World world = sim::makeWorld(sim::WorldName::Street, 1, kStreet);
  const sim::Trajectory path = sim::makeTrajectory(sim::WorldName::Street, kStreet);
  const Eigen::Vector3d start = path.poseAt(0.0).translation() + Eigen::Vector3d(from, 0.0, 0.0);
  sim::Sensor sensor = sim::makeSensor("64");
  sensor.columns = 1024;
  std::vector<Sweep> sweeps;
  for (int i = 0; i < kCount; ++i) {
    const double stamp = kPeriod * i;
    const auto pose = [&](double time) {
      const double metres = kSpeed * (stamp + (with_times ? time : 0.0));
      return Pose(Eigen::Translation3d(start + Eigen::Vector3d(metres, 0.0, 0.0)));
    };
    sweeps.push_back(castSweep(world, sensor, pose, stamp, static_cast<uint32_t>(i)));
    if (with_times) continue;
    for (auto& point : sweeps.back().points) point[3] = 0.0F;
  }
  return sweeps;
}

/// How far each scan is put from where it was taken [m]. The map begins in the middle of a sweep.
std::vector<double> errorsOf(const std::vector<Sweep>& sweeps, bool with_times,
                             const Config& config) {
  Mapper mapper(config);
  std::vector<double> errors;
  for (const VoxelScan& scan : voxelScans(sweeps, config)) {
    const ScanResult result = mapper.process(scan);
    EXPECT_TRUE(result.located()) << scan.stamp;
    const bool first = result.status == ScanStatus::kFirst;
    const double since_middle = scan.stamp - (with_times && !first ? kPeriod / 2 : 0.0);
    const Eigen::Vector3d expected(kSpeed * since_middle, 0.0, 0.0);
    errors.push_back((result.T_map_sensor.translation() - expected).norm());
  }
  return errors;
}

TEST(MaxSpeed, OfAMotorwayIsFollowedFromTheFirstScan) {
  for (const double from : {-200.0, 0.0, 150.0}) {
    for (const bool with_times : {false, true}) {
      const auto errors = errorsOf(drive(from, with_times), with_times, Config{});
      for (size_t i = 0; i < errors.size(); ++i) {
        EXPECT_LT(errors[i], 0.25) << i << " of " << from << (with_times ? ", with times" : "");
      }
    }
  }
}

TEST(MaxSpeed, BoundsTheSecondScan) {
  Config slow;
  slow.mapper.max_speed = 10.0;
  const std::vector<Sweep> sweeps = drive(0.0, false);
  Mapper mapper(slow);
  for (const VoxelScan& scan : voxelScans({sweeps[0], sweeps[1]}, slow)) {
    const double x = mapper.process(scan).T_map_sensor.translation().x();
    EXPECT_LE(x, 2.0 + 10.0 * kPeriod);
  }
}

TEST(MaxSpeed, BoundsTheOdometry) {
  Config slow;
  slow.mapper.max_speed = 30.0;
  const auto scans = voxelScans(drive(0.0, false), slow);
  for (const Config& config : {Config{}, slow}) {
    Mapper mapper(config);
    for (size_t i = 0; i < scans.size(); ++i) {
      ScanPrior prior;
      prior.T_odom_sensor = Pose(Eigen::Translation3d(kSpeed * scans[i].stamp * 1.2, 0.0, 0.0));
      const bool jumped = mapper.process(scans[i], prior).odometry_jumped;
      EXPECT_EQ(i > 0 && config.mapper.max_speed == 30.0, jumped) << i;
    }
  }
}

/// Where the second scan is put if the sensor has turned in between.
Pose poseAfter(const Pose& turn, const Config& config) {
  const sim::World room = furnishedRoom();
  sim::Sensor sensor = sim::makeSensor("32");
  sensor.columns = 512;
  std::vector<Sweep> sweeps;
  for (const Pose& pose : {Pose(Pose::Identity()), turn}) {
    const auto still = [&](double) { return pose; };
    sweeps.push_back(castSweep(room, sensor, still, kPeriod * static_cast<double>(sweeps.size()),
                               static_cast<uint32_t>(sweeps.size())));
    for (auto& point : sweeps.back().points) point[3] = 0.0F;
  }
  Mapper mapper(config);
  Pose pose;
  for (const VoxelScan& scan : voxelScans(sweeps, config)) pose = mapper.process(scan).T_map_sensor;
  return pose;
}

TEST(MaxTurn, BoundsAMatch) {
  constexpr double kDegrees = 70.0;
  const Pose turn(Eigen::AngleAxisd(kDegrees * M_PI / 180.0, Eigen::Vector3d::UnitZ()));
  EXPECT_LT(differenceOf(turn, poseAfter(turn, Config{})).degrees, 1.0);
  Config slow;
  slow.mapper.max_turn = 50.0;
  EXPECT_LE(differenceOf(Pose::Identity(), poseAfter(turn, slow)).degrees, 60.0 + 5.0);
}

}  // namespace
}  // namespace edgevox::test
