// SPDX-License-Identifier: BSD-3-Clause
#include "ros/map_publisher.hpp"

#include <utility>

#include "ros/map_messages.hpp"

namespace edgevox {

MapPublisher::MapPublisher(ros::NodeHandle handle, std::string map_frame)
    : map_frame_(std::move(map_frame)),
      edges_{handle.advertise<sensor_msgs::PointCloud2>("map_edges", 1, true)},
      occupied_{handle.advertise<sensor_msgs::PointCloud2>("map_occupied", 1, true)},
      boxes_{handle.advertise<visualization_msgs::Marker>("map_boxes", 1, true)} {}

bool MapPublisher::Topic::isDue(uint64_t current) const {
  return version != current && publisher.getNumSubscribers() > 0;
}

MapPublisher::Content MapPublisher::collect(const MapBuilder& map, uint64_t version) {
  Content content;
  content.has_boxes = boxes_.isDue(version);
  content.has_edges = edges_.isDue(version);
  content.has_occupied = occupied_.isDue(version);
  if (content.has_boxes) {
    map.edgeVoxels().forEach([&](const VoxelIndex& v) { content.boxes.push_back(v); });
    boxes_.version = version;
  }
  if (content.has_edges) {
    content.edges = centroidsOf(map, map.edgeVoxels());
    edges_.version = version;
  }
  if (content.has_occupied) {
    content.occupied = centroidsOf(map, map.hitVoxels());
    occupied_.version = version;
  }
  return content;
}

void MapPublisher::publish(const Content& content, double voxel_size,
                           const ros::Time& stamp) const {
  std_msgs::Header header;
  header.frame_id = map_frame_;
  header.stamp = stamp;
  if (content.has_boxes) boxes_.publisher.publish(toBoxes(content.boxes, voxel_size, header));
  if (content.has_edges) edges_.publisher.publish(toCloud(content.edges, header));
  if (content.has_occupied) occupied_.publisher.publish(toCloud(content.occupied, header));
}

}  // namespace edgevox
