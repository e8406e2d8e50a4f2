// SPDX-License-Identifier: BSD-3-Clause
#include "ros/simulated_scans.hpp"

#include <cstddef>
#include <cstring>
#include <variant>

#include "ros/conversions/point_cloud.hpp"

namespace edgevox::test {

CloudView viewOf(const sensor_msgs::PointCloud2& cloud) {
  return std::get<CheckedCloud>(readCloud(cloud, VoxelizerConfig())).view;
}

sensor_msgs::PointCloud2 stamped(sensor_msgs::PointCloud2 cloud, const ros::Time& stamp) {
  cloud.header.stamp = stamp;
  return cloud;
}

bool same(const Eigen::Vector3f& a, const geometry_msgs::Point32& b) {
  return a.x() == b.x && a.y() == b.y && a.z() == b.z;
}

bool same(const ScanVoxel& a, const Voxel& b) {
  return a.index == VoxelIndex{b.x, b.y, b.z} && same(a.centroid, b.centroid) &&
         a.time_offset == b.time_offset && a.point_count == b.point_count &&
         a.edge == (b.edge != 0);
}

::testing::AssertionResult sameScan(const VoxelScan& scan, const VoxelScanStamped& message) {
  if (scan.voxels.size() != message.voxels.size()) {
    return ::testing::AssertionFailure()
           << message.voxels.size() << " voxels instead of " << scan.voxels.size();
  }
  for (size_t i = 0; i < scan.voxels.size(); ++i) {
    if (!same(scan.voxels[i], message.voxels[i])) {
      return ::testing::AssertionFailure() << "voxel " << i << " differs";
    }
  }
  return ::testing::AssertionSuccess();
}

std::vector<std::string> settingsOf(const VoxelScanStamped& message) {
  std::vector<std::string> settings;
  for (const Setting& s : message.settings) settings.push_back(s.name + "=" + s.value);
  return settings;
}

std::vector<Eigen::Vector3f> pointsOf(const sensor_msgs::PointCloud2& cloud) {
  std::vector<Eigen::Vector3f> points(cloud.width);
  for (size_t i = 0; i < points.size(); ++i) {
    std::memcpy(points[i].data(), cloud.data.data() + i * cloud.point_step, sizeof(points[i]));
  }
  return points;
}

}  // namespace edgevox::test
