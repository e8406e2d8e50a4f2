// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/cloud_points.hpp"

#include <cstring>

namespace edgevox {
namespace {

template <typename Coordinate>
Eigen::Vector3f readPoint(const CloudView& cloud, const uint8_t* at) {
  Eigen::Vector3f point;
  for (int axis = 0; axis < 3; ++axis) {
    Coordinate value;
    std::memcpy(&value, at + cloud.xyz_offset[static_cast<size_t>(axis)], sizeof value);
    point[axis] = static_cast<float>(value);
  }
  return point;
}

}  // namespace

std::vector<Eigen::Vector3f> pointsOf(const CloudView& cloud, const VoxelizerConfig& config) {
  std::vector<Eigen::Vector3f> points;
  for (size_t row = 0; row < cloud.height; ++row) {
    const uint8_t* at = cloud.data + row * cloud.row_step;
    for (size_t i = 0; i < cloud.width; ++i, at += cloud.point_step) {
      const Eigen::Vector3f point = cloud.xyz_type == Scalar::kFloat64
                                        ? readPoint<double>(cloud, at)
                                        : readPoint<float>(cloud, at);
      const auto range = static_cast<double>(point.norm());  // NaN fails both comparisons
      if (range >= config.min_range && range <= config.max_range) points.push_back(point);
    }
  }
  return points;
}

}  // namespace edgevox
