// SPDX-License-Identifier: BSD-3-Clause
// A drive along a street and back: what was left behind is frozen, and found again.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "edgevox/mapping/mapper.hpp"
#include "support/sweeps.hpp"

namespace edgevox::test {
namespace {

constexpr double kStreet = 2400.0;  // m, so that one side of the loop is long enough
constexpr double kWay = 500.0;      // m, there and back again
constexpr double kRange = 60.0;     // m
constexpr double kFastest = 1.5;    // m a scan
constexpr double kGather = 0.05;    // m a scan faster than in the one before

/// How far along the way each scan is taken: at rest at both ends.
std::vector<double> places() {
  std::vector<double> places{0.0};
  for (double speed = 0.0, at = 0.0; at < kWay;) {
    const double braking = std::sqrt(2.0 * kGather * (kWay - at));
    speed = std::max(kGather, std::min({kFastest, speed + kGather, braking}));
    places.push_back(at += speed);
  }
  return places;
}

/// Sweeps without motion.
std::vector<Sweep> sweepsAt(const std::vector<double>& places) {
  const sim::World world = sim::makeWorld(sim::WorldName::Street, 1, kStreet);
  const sim::Trajectory path = sim::makeTrajectory(sim::WorldName::Street, kStreet);
  const Eigen::Vector3d start = path.poseAt(0.0).translation() - Eigen::Vector3d(200.0, 0.0, 0.0);
  sim::Sensor sensor = sim::makeSensor("32");
  sensor.columns = 512;
  sensor.max_range = kRange;
  std::vector<Sweep> sweeps;
  for (const double place : places) {
    const Pose pose(Eigen::Translation3d(start + Eigen::Vector3d(place, 0.0, 0.0)));
    sweeps.push_back(castSweep(
        world, sensor, [&](double) { return pose; }, 0.0, static_cast<uint32_t>(sweeps.size())));
    for (auto& point : sweeps.back().points) point[3] = 0.0F;
  }
  return sweeps;
}

struct Drive {
  double worst = 0.0;       // m, off the true position
  double worst_back = 0.0;  // the same on the way back, from where the map was made
  size_t lost = 0;
  size_t most_frozen = 0;  // voxels
};

Drive thereAndBack(const std::vector<double>& places, Mapper& mapper, const Config& config) {
  std::vector<Sweep> sweeps = sweepsAt(places);
  for (size_t i = places.size(); i-- > 0;) sweeps.push_back(sweeps[i]);
  for (size_t i = 0; i < sweeps.size(); ++i) sweeps[i].stamp = 0.25 * static_cast<double>(i);
  Drive drive;
  std::vector<Eigen::Vector3d> there;
  const std::vector<VoxelScan> scans = voxelScans(sweeps, config);
  for (size_t i = 0; i < scans.size(); ++i) {
    const ScanResult result = mapper.process(scans[i]);
    if (!result.located()) ++drive.lost;
    const bool back = i >= places.size();
    const size_t place = back ? 2 * places.size() - 1 - i : i;
    const Eigen::Vector3d at = result.T_map_sensor.translation();
    if (!back) there.push_back(at);
    drive.worst = std::max(drive.worst, (at - Eigen::Vector3d(places[place], 0.0, 0.0)).norm());
    drive.worst_back = std::max(drive.worst_back, (at - there[place]).norm());
    drive.most_frozen = std::max(drive.most_frozen, mapper.map().frozenVoxels());
  }
  return drive;
}

TEST(FarDrive, FindsItsWayBackByFrozenPlaces) {
  Config config;
  config.voxelizer.max_range = kRange;
  config.map.freeze_after = 20;
  Mapper mapper(config);
  const Drive drive = thereAndBack(places(), mapper, config);
  RecordProperty("worst_mm", static_cast<int>(1000 * drive.worst));
  RecordProperty("worst_back_mm", static_cast<int>(1000 * drive.worst_back));
  EXPECT_EQ(0U, drive.lost);
  EXPECT_GT(2.0, drive.worst);
  EXPECT_GT(0.1, drive.worst_back);
  EXPECT_LT(mapper.map().hitVoxelCount() / 2, drive.most_frozen);
  EXPECT_LT(100U, mapper.map().thawedRegions());
}

}  // namespace
}  // namespace edgevox::test
