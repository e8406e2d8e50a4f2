// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "edgevox/config.hpp"
#include "edgevox/grid/voxel.hpp"

namespace edgevox {

/// One occupied voxel of a scan, in the frame of the cloud.
struct ScanVoxel {
  VoxelIndex index;                                    ///< at VoxelScan::voxel_size
  Eigen::Vector3f centroid = Eigen::Vector3f::Zero();  ///< mean of its points [m]
  float time_offset = 0.0F;                            ///< mean of its points' times - stamp [s]
  uint32_t point_count = 0;
  bool edge = false;  ///< set by EdgeExtractor
};

/// Why points of a cloud were not used.
struct DroppedPoints {
  uint64_t not_finite = 0;
  uint64_t too_near = 0;
  uint64_t too_far = 0;
  uint64_t bad_time = 0;  ///< too far from the stamp

  uint64_t total() const { return not_finite + too_near + too_far + bad_time; }
  DroppedPoints& operator+=(const DroppedPoints& other) {
    not_finite += other.not_finite;
    too_near += other.too_near;
    too_far += other.too_far;
    bad_time += other.bad_time;
    return *this;
  }
};

/// One cloud as occupied voxels, block by block.
struct VoxelScan {
  double stamp = 0.0;       ///< of the cloud [s]
  std::string frame;        ///< of the cloud
  uint64_t number = 0;      ///< counts the clouds read
  double voxel_size = 0.0;  ///< [m]
  std::vector<ScanVoxel> voxels;
  uint64_t points_read = 0;
  DroppedPoints dropped;
  /// Why the cloud was given up, and what to do; then there are no voxels. Empty: it was not.
  std::string too_large;
};

/// The same in voxels of the map's size, twice as large; one is an edge if one in it is.
VoxelScan inMapVoxels(const VoxelScan& scan);
/// The edges of that.
VoxelScan edgeVoxels(const VoxelScan& scan);
/// The voxels that mapper/scan_voxels chooses, of a scan whose edges are marked.
VoxelScan voxelsToMatch(VoxelScan scan, ScanVoxels chosen);

}  // namespace edgevox
