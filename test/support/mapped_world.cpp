// SPDX-License-Identifier: BSD-3-Clause
#include "support/mapped_world.hpp"

#include "sim/parts.hpp"
#include "support/sweeps.hpp"

namespace edgevox::test {

using Eigen::Vector3d;

Pose poseOf(const Vector3d& position, double yaw) {
  Pose pose(Eigen::AngleAxisd(yaw, Vector3d::UnitZ()));
  pose.translation() = position;
  return pose;
}

VoxelScan scanFrom(const sim::World& world, const Pose& T_world_sensor, const Config& config,
                   uint32_t seed) {
  sim::Sensor sensor = sim::makeSensor("32");
  sensor.columns = 512;
  Sweep sweep = castSweep(
      world, sensor, [&](double) { return T_world_sensor; }, 0.1 * seed, seed);
  for (auto& point : sweep.points) point[3] = 0.0F;
  return voxelScans({sweep}, config)[0];
}

MatchMap mapFrom(const sim::World& world, const std::vector<Pose>& poses, const Config& config) {
  MapBuilder builder(config.voxel_size, config.map, config.edges, 1);
  uint32_t seed = 0;
  for (const Pose& pose : poses) {
    std::vector<Vector3d> centroids;
    for (const ScanVoxel& voxel : scanFrom(world, pose, config, seed++).voxels) {
      centroids.push_back(pose * voxel.centroid.cast<double>());
    }
    builder.insert(centroids, pose.translation());
  }
  builder.label();
  builder.prepareAll();
  return builder.completeMap();
}

sim::World twinRooms() {
  sim::Solids solids;
  const auto box = [&](const Vector3d& min, const Vector3d& max) {
    sim::addBox(solids, {0, 0, -1.4, 0}, min, max, 0.5);
  };
  const auto wall = [&](double x0, double y0, double x1, double y1,
                        const std::vector<sim::Opening>& openings) {
    sim::addWall(solids, {x0, y0, x1, y1, 0.2, -1.4, 1.4, openings}, 0.5);
  };
  box({-3.2, -0.2, -0.2}, {30.2, 8.2, 0.0});
  box({-3.2, -0.2, 2.8}, {30.2, 8.2, 3.0});
  wall(-3, 0, 30, 0, {});
  wall(-3, 2, 30, 2, {{6.5, 7.5, 0.0, 2.0}, {18.5, 19.5, 0.0, 2.0}});
  wall(-3, 0, -3, 2, {});
  wall(30, 0, 30, 2, {});
  for (const double x : {0.0, 12.0}) {
    wall(x, 2, x, 8, {});
    wall(x + 8, 2, x + 8, 8, {});
    wall(x, 8, x + 8, 8, {});
    sim::addTable(solids, {x + 2, 6.5, -1.4, 0.3}, 1.6, 0.8);
    sim::addShelf(solids, {x + 0.3, 4.0, -1.4, 0.0}, 1.2, 2.0);
    sim::addColumn(solids, {x + 6.2, 6.4, -1.4, 0.0}, 0.2, 2.8, 0.5);
  }
  sim::addShelf(solids, {-2.5, 0.4, -1.4, 1.57}, 0.8, 2.0);
  return sim::World(solids);
}

std::vector<Pose> posesInTwinRooms() {
  std::vector<Pose> poses;
  for (const double room : {0.0, 12.0}) {
    for (const double x : {1.5, 3.0, 4.0, 5.0, 6.5}) {
      for (const double y : {3.2, 4.4, 5.6, 6.2}) {
        poses.push_back(poseOf({room + x, y, 0.0}, x + y));
      }
    }
    poses.push_back(poseOf({room + 4.0, 2.0, 0.0}, 0.3));
  }
  for (double x = -2.0; x < 29.0; x += 1.5) poses.push_back(poseOf({x, 1.0, 0.0}, 0.5 * x));
  return poses;
}

}  // namespace edgevox::test
