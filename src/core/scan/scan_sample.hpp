// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "edgevox/grid/voxel.hpp"
#include "edgevox/scan/motion.hpp"
#include "edgevox/scan/voxel_scan.hpp"

namespace edgevox {

/// At most `count` voxels of the scan, spread over it, in an order fixed by hash: positions in
/// scan.voxels.
std::vector<size_t> sampleVoxels(const VoxelScan& scan, size_t count);
/// Their centroids, of a scan that was seen at once [m].
std::vector<Eigen::Vector3d> sampleCentroids(const VoxelScan& scan, size_t count);

/// First and last time offset of a scan's voxels from its stamp [s].
struct SweepTime {
  double first = 0.0;
  double last = 0.0;

  double middle() const { return (first + last) / 2; }
  bool instant() const { return first == last; }
};
SweepTime sweepTime(const VoxelScan& scan);

/// Moves points to where the sensor, moving by `twist`, would have seen them in the middle of the
/// sweep, where an error of the twist matters least.
class Deskew {
 public:
  Deskew(const SweepTime& sweep, const Twist& twist);

  Eigen::Vector3d operator()(const ScanVoxel& voxel) const;

 private:
  SweepTime sweep_;
  double poses_per_second_ = 0.0;
  std::vector<Pose> poses_;  // at even times from the first to the last; none: nothing moves
};

}  // namespace edgevox
