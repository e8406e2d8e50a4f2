// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace edgevox::test {

using Field = sensor_msgs::PointField;

Field makeField(const std::string& name, uint32_t offset, uint8_t type);

/// Puts a value into a point of the message.
template <typename T>
void put(sensor_msgs::PointCloud2& cloud, size_t row, size_t column, size_t offset, T value) {
  const size_t at = row * cloud.row_step + column * cloud.point_step + offset;
  std::memcpy(&cloud.data.at(at), &value, sizeof(T));
}

/// A cloud of float32 x, y, z at the start of `point_step` bytes, filled with 0xff elsewhere.
sensor_msgs::PointCloud2 makeCloud(const std::vector<Eigen::Vector3f>& points,
                                   uint32_t point_step = 12);

}  // namespace edgevox::test
