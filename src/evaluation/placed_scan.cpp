// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/placed_scan.hpp"

namespace edgevox {

TruePose standingAt(const Pose& T_map_sensor) {
  return [T_map_sensor](double) { return T_map_sensor; };
}

std::vector<Eigen::Vector3d> placedCentroids(const VoxelScan& scan, const TruePose& truth) {
  std::vector<Eigen::Vector3d> centroids;
  centroids.reserve(scan.voxels.size());
  for (const ScanVoxel& voxel : scan.voxels) {
    const Pose T_map_then = truth(static_cast<double>(voxel.time_offset));
    centroids.push_back(T_map_then * voxel.centroid.cast<double>());
  }
  return centroids;
}

VoxelScan seenAtOnce(VoxelScan scan, const TruePose& truth) {
  const std::vector<Eigen::Vector3d> placed = placedCentroids(scan, truth);
  const Pose T_sensor_map = truth(0.0).inverse();
  for (size_t i = 0; i < placed.size(); ++i) {
    scan.voxels[i].centroid = (T_sensor_map * placed[i]).cast<float>();
    scan.voxels[i].time_offset = 0.0F;
  }
  return scan;
}

}  // namespace edgevox
