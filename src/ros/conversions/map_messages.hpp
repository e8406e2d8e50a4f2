// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Header.h>
#include <visualization_msgs/Marker.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "edgevox/grid/voxel.hpp"

namespace edgevox {

/// x, y, z as float32 [m].
sensor_msgs::PointCloud2 toCloud(const std::vector<Eigen::Vector3f>& points,
                                 const std_msgs::Header& header);

/// Layers of voxels between which colours change.
struct Heights {
  int32_t low = 0;
  int32_t high = 0;
};
/// Of all but the lowest and highest 2 % of the voxels, which are given as their number by z.
Heights heightsOf(const std::map<int32_t, size_t>& layers);

/// One box for each voxel, coloured by its height; a deletion if there are none.
visualization_msgs::Marker toBoxes(const std::vector<VoxelIndex>& voxels, double voxel_size,
                                   const Heights& heights, const std_msgs::Header& header);
/// The same, coloured from the lowest to the highest.
visualization_msgs::Marker toBoxes(const std::vector<VoxelIndex>& voxels, double voxel_size,
                                   const std_msgs::Header& header);

}  // namespace edgevox
