// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversions/map_messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace edgevox {
namespace {

// From low to high: evenly brighter, and told apart by the colour-blind.
constexpr std::array<std::array<float, 3>, 6> kColours = {{{0.28F, 0.20F, 0.55F},
                                                           {0.20F, 0.39F, 0.66F},
                                                           {0.13F, 0.57F, 0.61F},
                                                           {0.30F, 0.73F, 0.45F},
                                                           {0.68F, 0.84F, 0.25F},
                                                           {0.99F, 0.91F, 0.25F}}};

constexpr size_t kRim = 50;  // one voxel in as many is left out at either end of the heights

/// 0 <= height <= 1
std_msgs::ColorRGBA colourOf(float height) {
  const float position = height * static_cast<float>(kColours.size() - 1);
  const size_t below = std::min(static_cast<size_t>(position), kColours.size() - 2);
  const float part = position - static_cast<float>(below);
  const auto mix = [&](size_t channel) {
    return kColours[below][channel] +
           part * (kColours[below + 1][channel] - kColours[below][channel]);
  };
  std_msgs::ColorRGBA colour;
  colour.r = mix(0);
  colour.g = mix(1);
  colour.b = mix(2);
  colour.a = 1.0F;
  return colour;
}

}  // namespace

Heights heightsOf(const std::map<int32_t, size_t>& layers) {
  size_t count = 0;
  for (const auto& layer : layers) count += layer.second;
  if (count == 0) return {};
  const auto at = [&](size_t rank) {
    auto layer = layers.begin();
    for (; rank >= layer->second; ++layer) rank -= layer->second;
    return layer->first;
  };
  return {at(count / kRim), at(count - 1 - count / kRim)};
}

sensor_msgs::PointCloud2 toCloud(const std::vector<Eigen::Vector3f>& points,
                                 const std_msgs::Header& header) {
  static_assert(sizeof(Eigen::Vector3f) == 12, "points are packed");
  sensor_msgs::PointCloud2 cloud;
  cloud.header = header;
  for (const char* name : {"x", "y", "z"}) {
    sensor_msgs::PointField field;
    field.name = name;
    field.offset = static_cast<uint32_t>(4 * cloud.fields.size());
    field.datatype = sensor_msgs::PointField::FLOAT32;
    field.count = 1;
    cloud.fields.push_back(field);
  }
  cloud.height = 1;
  cloud.width = static_cast<uint32_t>(points.size());
  cloud.point_step = sizeof(Eigen::Vector3f);
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.is_bigendian = 0;
  cloud.is_dense = 1;
  cloud.data.resize(cloud.row_step);
  if (!points.empty()) std::memcpy(cloud.data.data(), points.data(), cloud.data.size());
  return cloud;
}

visualization_msgs::Marker toBoxes(const std::vector<VoxelIndex>& voxels, double voxel_size,
                                   const Heights& heights, const std_msgs::Header& header) {
  visualization_msgs::Marker boxes;
  boxes.header = header;
  boxes.ns = "edges";
  boxes.type = visualization_msgs::Marker::CUBE_LIST;
  boxes.action =
      voxels.empty() ? visualization_msgs::Marker::DELETE : visualization_msgs::Marker::ADD;
  boxes.pose.orientation.w = 1.0;
  boxes.scale.x = boxes.scale.y = boxes.scale.z = voxel_size;
  boxes.color.a = 1.0F;
  if (voxels.empty()) return boxes;
  const auto range = static_cast<float>(std::max(heights.high - heights.low, 1));
  boxes.points.reserve(voxels.size());
  boxes.colors.reserve(voxels.size());
  for (const VoxelIndex& voxel : voxels) {
    const Eigen::Vector3d centre = voxelCentre(voxel, voxel_size);
    geometry_msgs::Point point;
    point.x = centre.x();
    point.y = centre.y();
    point.z = centre.z();
    boxes.points.push_back(point);
    const auto height = static_cast<float>(std::clamp(voxel.z, heights.low, heights.high));
    boxes.colors.push_back(colourOf((height - static_cast<float>(heights.low)) / range));
  }
  return boxes;
}

visualization_msgs::Marker toBoxes(const std::vector<VoxelIndex>& voxels, double voxel_size,
                                   const std_msgs::Header& header) {
  std::map<int32_t, size_t> layers;
  for (const VoxelIndex& voxel : voxels) ++layers[voxel.z];
  return toBoxes(voxels, voxel_size, heightsOf(layers), header);
}

}  // namespace edgevox
