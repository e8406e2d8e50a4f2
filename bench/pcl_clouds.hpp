// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include "edgevox/config.hpp"
#include "edgevox/scan/voxelizer.hpp"

namespace edgevox::bench {

using PclCloud = pcl::PointCloud<pcl::PointXYZ>;

/// The points that the voxelizer would use.
PclCloud::Ptr pclCloud(const CloudView& cloud, const VoxelizerConfig& config);

/// By pcl::VoxelGrid.
PclCloud::Ptr filtered(const PclCloud::ConstPtr& cloud, float leaf);

}  // namespace edgevox::bench
