// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/movers.hpp"
#include "sim/sensor.hpp"
#include "sim/trajectory.hpp"
#include "sim/world.hpp"

namespace edgevox::sim {

/// One sweep. Each point is in the sensor frame at its own time, column by column, ring by ring;
/// the four arrays run in parallel.
struct Scan {
  double stamp = 0.0;                   ///< s from the trajectory's start, start of the sweep
  std::vector<Eigen::Vector3f> points;  ///< m
  std::vector<float> times;             ///< s after the stamp
  std::vector<float> intensities;       ///< 0 to 255, whole numbers
  std::vector<std::uint16_t> rings;     ///< 0 lowest

  std::size_t size() const { return points.size(); }
};

/// Sweeps that start and end within the trajectory.
int countSweeps(const Trajectory& trajectory, const Sensor& sensor);

/// The sweep number `sweep` (stamp sweep * sensor.period) of the world and of the movers as they
/// are at the time of each ray. Depends on the arguments alone and is safe to call from several
/// threads.
Scan simulateSweep(const World& world, const Trajectory& trajectory, const Sensor& sensor,
                   int sweep, std::uint64_t seed, const Movers& movers = {});

/// Sweeps first .. first + count - 1 on up to `threads` threads (at least one); the result does
/// not depend on `threads`.
std::vector<Scan> simulateSweeps(const World& world, const Trajectory& trajectory,
                                 const Sensor& sensor, int first, int count, std::uint64_t seed,
                                 unsigned threads, const Movers& movers = {});

/// The points in the world frame, each moved by the true pose at its own time; m.
std::vector<Eigen::Vector3d> pointsInWorld(const Scan& scan, const Trajectory& trajectory);

}  // namespace edgevox::sim
