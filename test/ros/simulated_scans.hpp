// SPDX-License-Identifier: BSD-3-Clause
// Simulated clouds, and what the core makes of them.
#pragma once

#include <edgevox/VoxelScanStamped.h>
#include <gtest/gtest.h>
#include <sensor_msgs/PointCloud2.h>

#include <string>
#include <vector>

#include "edgevox/scan/voxel_scan.hpp"
#include "edgevox/scan/voxelizer.hpp"

namespace edgevox::test {

CloudView viewOf(const sensor_msgs::PointCloud2& cloud);

/// The same at another time.
sensor_msgs::PointCloud2 stamped(sensor_msgs::PointCloud2 cloud, const ros::Time& stamp);

bool same(const Eigen::Vector3f& a, const geometry_msgs::Point32& b);
bool same(const ScanVoxel& a, const Voxel& b);

/// Whether all voxels of the message are those of the core.
::testing::AssertionResult sameScan(const VoxelScan& scan, const VoxelScanStamped& message);

/// "name=value" of each setting.
std::vector<std::string> settingsOf(const VoxelScanStamped& message);

/// The points of a cloud of packed x, y, z.
std::vector<Eigen::Vector3f> pointsOf(const sensor_msgs::PointCloud2& cloud);

}  // namespace edgevox::test
