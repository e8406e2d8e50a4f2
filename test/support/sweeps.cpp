// SPDX-License-Identifier: BSD-3-Clause
#include "support/sweeps.hpp"

#include <cmath>
#include <cstring>
#include <limits>

#include "edgevox/scan/motion.hpp"
#include "sim/parts.hpp"
#include "sim/scanner.hpp"
#include "support/random.hpp"

namespace edgevox::test {

CloudView Sweep::view() const {
  CloudView view;
  view.stamp = stamp;
  view.frame = "lidar";
  view.data = reinterpret_cast<const uint8_t*>(points.data());
  view.width = points.size();
  view.height = 1;
  view.point_step = sizeof(points[0]);
  view.row_step = points.size() * sizeof(points[0]);
  view.time.present = true;
  view.time.offset = 3 * sizeof(float);
  return view;
}

Walk simulateWalk(sim::WorldName name, const char* sensor_name, int first, int count) {
  const sim::Sensor sensor = sim::makeSensor(sensor_name);
  const sim::World world = sim::makeWorld(name, 1);
  const sim::Trajectory path = sim::makeTrajectory(name, sensor);
  const Pose T_first_world = path.poseAt(first * sensor.period).inverse();
  Walk walk;
  for (const sim::Scan& scan : sim::simulateSweeps(world, path, sensor, first, count, 1, 2)) {
    Sweep& sweep = walk.sweeps.emplace_back();
    sweep.stamp = scan.stamp;
    for (size_t i = 0; i < scan.size(); ++i) {
      const Eigen::Vector3f& p = scan.points[i];
      sweep.points.push_back({p.x(), p.y(), p.z(), scan.times[i]});
    }
    walk.truth.push_back({scan.stamp, T_first_world * path.poseAt(scan.stamp)});
  }
  return walk;
}

Sweep castSweep(const sim::World& world, const sim::Sensor& sensor,
                const std::function<Pose(double)>& T_world_sensor, double stamp, uint32_t seed) {
  Random random(seed);
  Sweep sweep;
  sweep.stamp = stamp;
  for (int column = 0; column < sensor.columns; ++column) {
    const double turn = static_cast<double>(column) / sensor.columns;
    const double time = turn * sensor.period;
    const double azimuth = 2.0 * M_PI * turn - M_PI;
    const Pose pose = T_world_sensor(time);
    for (const double elevation : sensor.elevations) {
      const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                      std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const auto hit =
          world.castRay(pose.translation(), pose.linear() * direction, sensor.max_range);
      if (!hit) continue;
      const Eigen::Vector3f p =
          ((hit->range + sensor.noise * random.normal()) * direction).cast<float>();
      sweep.points.push_back({p.x(), p.y(), p.z(), static_cast<float>(time)});
    }
  }
  return sweep;
}

sim::World furnishedRoom() {
  sim::Solids solids;
  const sim::Place here{0, 0, -1.4, 0};
  const auto box = [&](const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
    sim::addBox(solids, here, min, max, 0.5);
  };
  box({-4.2, -3.2, -0.2}, {4.2, 3.2, 0.0});
  box({-4.2, -3.2, 2.8}, {4.2, 3.2, 3.0});
  box({-4.2, -3.2, 0.0}, {-4.0, 3.2, 2.8});
  box({4.0, -3.2, 0.0}, {4.2, 3.2, 2.8});
  box({-4.2, -3.2, 0.0}, {4.2, -3.0, 2.8});
  box({-4.2, 3.0, 0.0}, {4.2, 3.2, 2.8});
  box({2.6, 1.9, 0.0}, {4.0, 3.0, 2.8});  // a chimney
  sim::addTable(solids, {-2.0, 1.5, -1.4, 0.3}, 1.6, 0.8);
  sim::addShelf(solids, {-3.8, -1.0, -1.4, 0.0}, 1.2, 2.0);
  sim::addSofa(solids, {1.5, -2.4, -1.4, 1.57}, 1.8);
  sim::addChair(solids, {-1.2, 0.6, -1.4, 1.0});
  sim::addColumn(solids, {2.2, 0.4, -1.4, 0.0}, 0.2, 2.8, 0.5);
  return sim::World(solids);
}

std::vector<VoxelScan> voxelScans(const std::vector<Sweep>& sweeps, const Config& config) {
  Voxelizer voxelizer(config.voxelizer, config.voxel_size);
  std::vector<VoxelScan> scans;
  for (const Sweep& sweep : sweeps) scans.push_back(voxelizer.voxelize(sweep.view()));
  return scans;
}

const Walk& buildingWalk() {
  static const Walk made = simulateWalk(sim::WorldName::Building, "32", 15, 60);
  return made;
}

const std::vector<VoxelScan>& buildingScans() {
  static const std::vector<VoxelScan> made = voxelScans(buildingWalk().sweeps, Config{});
  return made;
}

Sweep randomSweep(uint32_t seed, double stamp, int points) {
  Random random(seed);
  Sweep sweep;
  sweep.stamp = stamp;
  for (int i = 0; i < points; ++i) {
    const Eigen::Vector3f p = random.vectorIn(-5, 5).cast<float>();
    sweep.points.push_back({p.x(), p.y(), p.z(), 0.0F});
  }
  return sweep;
}

PoseDifference differenceOf(const Pose& a, const Pose& b) {
  const Pose change = a.inverse() * b;
  return {change.translation().norm(), rotationAngle(change) * 180.0 / M_PI};
}

bool sameBits(const Pose& a, const Pose& b) {
  return std::memcmp(a.data(), b.data(), 16 * sizeof(double)) == 0;
}

}  // namespace edgevox::test
