// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cloud_message.hpp"

namespace edgevox::test {

Field makeField(const std::string& name, uint32_t offset, uint8_t type) {
  Field field;
  field.name = name;
  field.offset = offset;
  field.datatype = type;
  field.count = 1;
  return field;
}

sensor_msgs::PointCloud2 makeCloud(const std::vector<Eigen::Vector3f>& points,
                                   uint32_t point_step) {
  sensor_msgs::PointCloud2 cloud;
  cloud.header.frame_id = "lidar";
  cloud.header.stamp = ros::Time(1600000000, 500000000);
  cloud.fields = {makeField("x", 0, Field::FLOAT32), makeField("y", 4, Field::FLOAT32),
                  makeField("z", 8, Field::FLOAT32)};
  cloud.width = static_cast<uint32_t>(points.size());
  cloud.height = 1;
  cloud.point_step = point_step;
  cloud.row_step = cloud.width * point_step;
  cloud.is_bigendian = 0;
  cloud.is_dense = 1;
  cloud.data.assign(cloud.row_step, 0xff);
  for (size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      put(cloud, 0, i, 4 * static_cast<size_t>(axis), points[i][axis]);
    }
  }
  return cloud;
}

}  // namespace edgevox::test
