// SPDX-License-Identifier: BSD-3-Clause
// What the registrations of PCL that are compared with take and give.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Core>

#include "edgevox/scan/motion.hpp"
#include "edgevox/scan/voxel_scan.hpp"

namespace edgevox {

using PclCloud = pcl::PointCloud<pcl::PointXYZ>;

inline void add(const Eigen::Vector3f& point, PclCloud& cloud) {
  cloud.push_back(pcl::PointXYZ(point.x(), point.y(), point.z()));
}

/// The centroids of a scan, in its frame [m].
inline PclCloud::Ptr cloudOf(const VoxelScan& scan) {
  PclCloud::Ptr cloud(new PclCloud);
  for (const ScanVoxel& voxel : scan.voxels) add(voxel.centroid, *cloud);
  return cloud;
}

/// PCL computes in floats.
inline Pose poseOf(const Eigen::Matrix4f& matrix) {
  Pose pose = Pose::Identity();
  pose.matrix() = matrix.cast<double>();
  renormalise(pose);
  return pose;
}

}  // namespace edgevox
