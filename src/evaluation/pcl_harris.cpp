// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <pcl/keypoints/harris_3d.h>

#include "evaluation/edge_detectors.hpp"
#include "evaluation/pcl_points.hpp"

namespace edgevox {
namespace {

constexpr double kRadius = 3.5;  // voxels, of the normals and of what is compared

}  // namespace

Responses harris3d(const VoxelScan& scan) {
  if (scan.voxels.empty()) return {};
  pcl::HarrisKeypoint3D<pcl::PointXYZ, pcl::PointXYZI> harris;
  harris.setInputCloud(cloudOf(scan));
  harris.setRadius(static_cast<float>(kRadius * scan.voxel_size));
  harris.setNonMaxSupression(false);
  harris.setRefine(false);
  pcl::PointCloud<pcl::PointXYZI> found;
  harris.compute(found);
  Responses responses;
  for (const pcl::PointXYZI& point : found) {
    responses.push_back(std::isfinite(point.intensity) ? static_cast<double>(point.intensity) : 0);
  }
  return responses;
}

}  // namespace edgevox
