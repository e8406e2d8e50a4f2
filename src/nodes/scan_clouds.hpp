// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <edgevox/VoxelScanStamped.h>
#include <sensor_msgs/PointCloud2.h>

#include "ros/conversions/map_messages.hpp"

namespace edgevox {

enum class ScanPart { kAll, kEdges };

/// Centroids of a scan's voxels, with its header.
inline sensor_msgs::PointCloud2 cloudOf(const VoxelScanStamped& scan, ScanPart part) {
  std::vector<Eigen::Vector3f> points;
  points.reserve(scan.voxels.size());
  for (const Voxel& voxel : scan.voxels) {
    if (part == ScanPart::kEdges && voxel.edge == 0) continue;
    points.emplace_back(voxel.centroid.x, voxel.centroid.y, voxel.centroid.z);
  }
  return toCloud(points, scan.header);
}

}  // namespace edgevox
