// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Header.h>
#include <visualization_msgs/Marker.h>

#include <vector>

#include "edgevox/grid/voxel.hpp"

namespace edgevox {

/// x, y, z as float32 [m].
sensor_msgs::PointCloud2 toCloud(const std::vector<Eigen::Vector3f>& points,
                                 const std_msgs::Header& header);

/// One box for each voxel, coloured from the lowest to the highest.
visualization_msgs::Marker toBoxes(const std::vector<VoxelIndex>& voxels, double voxel_size,
                                   const std_msgs::Header& header);

}  // namespace edgevox
