// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "edgevox/grid/pool.hpp"
#include "edgevox/io/trajectory_io.hpp"
#include "edgevox/mapping/pipeline.hpp"
#include "edgevox/scan/voxel_scan.hpp"
#include "edgevox/stage_times.hpp"

namespace edgevox {

/// What is remembered of one scan.
struct ScanRecord {
  uint64_t cloud = 0;  ///< counts the clouds of the input, from 0
  double stamp = 0.0;  ///< [s]
  ScanStatus status = ScanStatus::kLost;
  float hit_ratio = 0.0F;
  uint32_t points = 0;
  uint32_t voxels = 0;
  float sparse_share = 0.0F;  ///< EdgeCount::sparseShare(); NaN: not known
  StageTimes times;           ///< extract: NaN where it is not known
  float total = 0.0F;         ///< time of the whole pipeline [s]
  float latency = 0.0F;  ///< from the arrival of the cloud to its pose, 0 where there is none [s]
};

/// A pose in 64 bytes.
struct PoseRecord {
  double stamp = 0.0;                   ///< [s]
  std::array<double, 4> rotation{};     ///< x, y, z, w
  std::array<double, 3> translation{};  ///< [m]
};

/// An account of a run, for its files. Grows by 140 bytes a scan; copies share these, see Pool.
struct RunRecord {
  Pool<ScanRecord> scans;
  /// T_map_base of the located scans; without a base frame of the sensor.
  Pool<PoseRecord> poses;
  std::map<std::string, size_t> left_out;  ///< clouds that were not mapped, by reason
  size_t without_odometry = 0;             ///< scans, though an odometry frame is used
  size_t odometry_jumps = 0;               ///< scans whose odometry was not used
  size_t clock_jumps = 0;
  size_t degenerate = 0;  ///< scans that the geometry around leaves open in a direction or more
  size_t begun_anew = 0;  ///< maps, as nothing fitted the one before, whose poses are dropped
  uint64_t refused = 0;   ///< online: clouds that could not be read
  uint64_t dropped = 0;   ///< online: clouds and scans dropped by full queues
  uint64_t points = 0;
  DroppedPoints dropped_points;
  std::string time_field;  ///< empty: the points have no times

  void add(uint64_t cloud, const PipelineResult& result, const Pose& T_base_sensor, double total,
           double latency = 0.0);
  size_t count(ScanStatus status) const;
  size_t located() const { return poses.size(); }
  Trajectory trajectory() const;
};

}  // namespace edgevox
