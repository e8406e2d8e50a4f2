// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversions/map_messages.hpp"

#include <gtest/gtest.h>

#include "ros/conversions/point_cloud.hpp"

namespace edgevox {
namespace {

std_msgs::Header header() {
  std_msgs::Header header;
  header.frame_id = "map";
  header.stamp = ros::Time(3, 4);
  return header;
}

TEST(MapCloud, isReadBackByOurOwnReader) {
  const std::vector<Eigen::Vector3f> points = {{1, 2, 3}, {-4, 5.5F, 1e-3F}};
  const sensor_msgs::PointCloud2 cloud = toCloud(points, header());
  EXPECT_EQ("map", cloud.header.frame_id);
  const CloudReading reading = readCloud(cloud, VoxelizerConfig());
  ASSERT_TRUE(std::holds_alternative<CheckedCloud>(reading));
  const CloudView& view = std::get<CheckedCloud>(reading).view;
  ASSERT_EQ(2U, view.width);
  for (size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(points[i], Eigen::Map<const Eigen::Vector3f>(
                             reinterpret_cast<const float*>(view.data + i * view.point_step)));
  }
  EXPECT_EQ(0U, toCloud({}, header()).width);
}

TEST(Boxes, haveTheVoxelsPlaceAndSize) {
  const auto boxes = toBoxes({{0, 0, 0}, {-1, 2, 10}}, 0.5, header());
  EXPECT_EQ(visualization_msgs::Marker::CUBE_LIST, boxes.type);
  EXPECT_EQ(visualization_msgs::Marker::ADD, boxes.action);
  EXPECT_EQ(0.5, boxes.scale.x);
  EXPECT_EQ(0.5, boxes.scale.z);
  EXPECT_EQ(1.0, boxes.pose.orientation.w);
  ASSERT_EQ(2U, boxes.points.size());
  EXPECT_EQ(0.25, boxes.points[0].x);
  EXPECT_EQ(-0.25, boxes.points[1].x);
  EXPECT_EQ(1.25, boxes.points[1].y);
  EXPECT_EQ(5.25, boxes.points[1].z);
}

TEST(Boxes, getBrighterWithHeight) {
  std::vector<VoxelIndex> voxels;
  for (int z = -20; z < 20; ++z) voxels.push_back({0, 0, z});
  const auto boxes = toBoxes(voxels, 0.2, header());
  ASSERT_EQ(voxels.size(), boxes.colors.size());
  const auto brightness = [](const auto& c) { return 0.3F * c.r + 0.6F * c.g + 0.1F * c.b; };
  for (size_t i = 1; i < voxels.size(); ++i) {
    EXPECT_GT(brightness(boxes.colors[i]), brightness(boxes.colors[i - 1])) << i;
    EXPECT_EQ(1.0F, boxes.colors[i].a);
  }
}

TEST(Boxes, ofOneLayerAndOfNone) {
  EXPECT_EQ(3U, toBoxes({{0, 0, 7}, {1, 0, 7}, {2, 0, 7}}, 0.2, header()).colors.size());
  EXPECT_EQ(visualization_msgs::Marker::DELETE, toBoxes({}, 0.2, header()).action);
}

}  // namespace
}  // namespace edgevox
