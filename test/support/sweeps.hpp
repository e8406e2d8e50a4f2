// SPDX-License-Identifier: BSD-3-Clause
// Simulated sweeps as clouds and voxel scans.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "edgevox/config.hpp"
#include "edgevox/io/trajectory_io.hpp"
#include "edgevox/scan/voxel_scan.hpp"
#include "edgevox/scan/voxelizer.hpp"
#include "sim/sensor.hpp"
#include "sim/world.hpp"
#include "sim/worlds.hpp"

namespace edgevox::test {

/// A cloud that owns its points: x, y, z [m], time after the stamp [s].
struct Sweep {
  double stamp = 0.0;  ///< [s]
  std::vector<std::array<float, 4>> points;

  CloudView view() const;
};

/// Consecutive sweeps of a walk and the true poses at their stamps, in the frame of the first.
struct Walk {
  std::vector<Sweep> sweeps;
  Trajectory truth;
};

Walk simulateWalk(sim::WorldName world, const char* sensor, int first, int count);

/// A sweep from `T_world_sensor(time after the stamp)`, with noise of `sensor.noise`.
Sweep castSweep(const sim::World& world, const sim::Sensor& sensor,
                const std::function<Pose(double)>& T_world_sensor, double stamp, uint32_t seed);

/// A furnished room of 8 x 6 x 2.8 m about the origin, without symmetry; the floor at -1.4 m.
sim::World furnishedRoom();

std::vector<VoxelScan> voxelScans(const std::vector<Sweep>& sweeps, const Config& config);

/// The first 60 sweeps of 32 beams in motion in the building: until then the sensor stands still.
const Walk& buildingWalk();
/// Their voxel scans with the defaults.
const std::vector<VoxelScan>& buildingScans();

/// Points at random in a cube of 10 m about the sensor.
Sweep randomSweep(uint32_t seed, double stamp, int points);

struct PoseDifference {
  double metres;
  double degrees;
};
PoseDifference differenceOf(const Pose& a, const Pose& b);

/// Every bit alike.
bool sameBits(const Pose& a, const Pose& b);

}  // namespace edgevox::test
