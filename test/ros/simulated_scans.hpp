// SPDX-License-Identifier: BSD-3-Clause
// Simulated clouds, and what the core makes of them.
#pragma once

#include <edgevox/VoxelScanStamped.h>
#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "edgevox/config.hpp"
#include "edgevox/scan/voxel_scan.hpp"
#include "edgevox/scan/voxelizer.hpp"
#include "ros/conversions/point_cloud.hpp"
#include "tools/simulated_bag.hpp"

namespace edgevox::test {

inline CloudView viewOf(const sensor_msgs::PointCloud2& cloud) {
  return std::get<CheckedCloud>(readCloud(cloud)).view;
}

/// The same at another time.
inline sensor_msgs::PointCloud2 stamped(sensor_msgs::PointCloud2 cloud, const ros::Time& stamp) {
  cloud.header.stamp = stamp;
  return cloud;
}

inline bool same(const Eigen::Vector3f& a, const geometry_msgs::Point32& b) {
  return a.x() == b.x && a.y() == b.y && a.z() == b.z;
}

inline bool same(const ScanVoxel& a, const Voxel& b) {
  return a.index == VoxelIndex{b.x, b.y, b.z} && same(a.centroid, b.centroid) &&
         a.time_offset == b.time_offset && a.point_count == b.point_count &&
         a.edge == (b.edge != 0);
}

/// Whether all voxels of the message are those of the core.
inline ::testing::AssertionResult sameScan(const VoxelScan& scan, const VoxelScanStamped& message) {
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

/// "name=value" of each setting.
inline std::vector<std::string> settingsOf(const VoxelScanStamped& message) {
  std::vector<std::string> settings;
  for (const Setting& s : message.settings) settings.push_back(s.name + "=" + s.value);
  return settings;
}

/// The points of a cloud of packed x, y, z.
inline std::vector<Eigen::Vector3f> pointsOf(const sensor_msgs::PointCloud2& cloud) {
  std::vector<Eigen::Vector3f> points(cloud.width);
  for (size_t i = 0; i < points.size(); ++i) {
    std::memcpy(points[i].data(), cloud.data.data() + i * cloud.point_step, sizeof(points[i]));
  }
  return points;
}

}  // namespace edgevox::test
