// SPDX-License-Identifier: BSD-3-Clause
// The scans that all benchmarks run on.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "edgevox/config.hpp"
#include "edgevox/scan/voxel_scan.hpp"
#include "edgevox/scan/voxelizer.hpp"
#include "evaluation/recording.hpp"

namespace edgevox::bench {

using Cloud = RecordedScan;

/// Consecutive clouds of a moving sensor, and what the pipeline made of them. The first half
/// builds a map; the second half is what is timed.
struct Sequence {
  Config config;
  std::vector<Cloud> clouds;
  std::vector<VoxelScan> scans;
  std::vector<Pose> poses;                              ///< T_map_sensor
  std::vector<std::vector<Eigen::Vector3d>> centroids;  ///< deskewed, in the map frame [m]

  size_t size() const { return clouds.size(); }
  size_t half() const { return size() / 2; }
  /// The scan for benchmarks of one scan, and of the pair it makes with the one before.
  size_t sample() const { return size() * 3 / 4; }
  /// The pose of scan i at constant velocity.
  Pose predicted(size_t i) const { return poses[i - 1] * poses[i - 2].inverse() * poses[i - 1]; }
};

/// Those that can be had: simulated ones, and recorded ones where their bags are found in the
/// folder that the environment variable EDGEVOX_DATA names.
std::vector<std::string> sequenceNames();

/// Made or read at its first use. Throws std::runtime_error.
const Sequence& sequence(const std::string& name);

}  // namespace edgevox::bench
