// SPDX-License-Identifier: BSD-3-Clause
#include "pcl_clouds.hpp"

#include <cstring>
#include <stdexcept>

#include <pcl/filters/voxel_grid.h>

namespace edgevox::bench {

PclCloud::Ptr pclCloud(const CloudView& cloud, const VoxelizerConfig& config) {
  if (cloud.xyz_type != Scalar::kFloat32) throw std::runtime_error("coordinates are not float32");
  PclCloud::Ptr out(new PclCloud);
  for (size_t row = 0; row < cloud.height; ++row) {
    const uint8_t* at = cloud.data + row * cloud.row_step;
    for (size_t i = 0; i < cloud.width; ++i, at += cloud.point_step) {
      pcl::PointXYZ point;
      for (size_t axis = 0; axis < 3; ++axis) {
        std::memcpy(&point.data[axis], at + cloud.xyz_offset[axis], sizeof(float));
      }
      const double range = static_cast<double>(point.getVector3fMap().norm());
      if (range >= config.min_range && range <= config.max_range) out->push_back(point);
    }
  }
  return out;
}

PclCloud::Ptr filtered(const PclCloud::ConstPtr& cloud, float leaf) {
  pcl::VoxelGrid<pcl::PointXYZ> filter;
  filter.setLeafSize(leaf, leaf, leaf);
  filter.setInputCloud(cloud);
  PclCloud::Ptr out(new PclCloud);
  filter.filter(*out);
  return out;
}

}  // namespace edgevox::bench
