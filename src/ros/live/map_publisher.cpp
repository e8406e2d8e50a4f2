// SPDX-License-Identifier: BSD-3-Clause
#include "ros/live/map_publisher.hpp"

#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/Marker.h>

#include <utility>

#include "ros/conversions/map_messages.hpp"

namespace edgevox {
namespace {

constexpr double kWholesShare = 0.05;  // of the time, for the whole map
constexpr uint32_t kUpdates = 10;      // that wait for a slow listener

}  // namespace

MapPublisher::MapPublisher(ros::NodeHandle handle, std::string map_frame)
    : map_frame_(std::move(map_frame)),
      edges_{handle.advertise<sensor_msgs::PointCloud2>("map_edges", 1, true)},
      occupied_{handle.advertise<sensor_msgs::PointCloud2>("map_occupied", 1, true)},
      boxes_{handle.advertise<visualization_msgs::Marker>("map_boxes", 1, true)},
      joined_(std::make_shared<std::atomic<bool>>(false)),
      update_{handle.advertise<visualization_msgs::MarkerArray>(
          "map_boxes_update", kUpdates,
          [joined = joined_](const ros::SingleSubscriberPublisher&) { *joined = true; })} {}

bool MapPublisher::Topic::isDue(uint64_t current) const {
  return version != current && publisher.getNumSubscribers() > 0;
}

bool MapPublisher::isUpdateDue(uint64_t version) const {
  return update_.isDue(version) || (*joined_ && update_.publisher.getNumSubscribers() > 0);
}

bool MapPublisher::isDue(uint64_t version) const {
  const bool wholes = edges_.isDue(version) || occupied_.isDue(version) || boxes_.isDue(version);
  return isUpdateDue(version) || (wholes && areWholesDue());
}

void MapPublisher::publish(const MapSnapshot& snapshot) {
  std_msgs::Header header;
  header.frame_id = map_frame_;
  header.stamp = snapshot.stamp;
  if (isUpdateDue(snapshot.version)) publishUpdate(snapshot, header);
  if (areWholesDue()) publishWholes(snapshot, header);
}

void MapPublisher::publishWholes(const MapSnapshot& snapshot, const std_msgs::Header& header) {
  const ros::WallTime begin = ros::WallTime::now();
  const auto take = [&](Topic& topic) {
    const bool due = topic.isDue(snapshot.version);
    if (due) topic.version = snapshot.version;
    return due;
  };
  if (take(boxes_)) {
    std::vector<VoxelIndex> voxels;
    snapshot.edge_voxels.forEach([&](const VoxelIndex& v) { voxels.push_back(v); });
    boxes_.publisher.publish(toBoxes(voxels, snapshot.voxel_size, header));
  }
  if (take(edges_)) edges_.publisher.publish(toCloud(snapshot.edge_centroids(), header));
  if (take(occupied_)) occupied_.publisher.publish(toCloud(snapshot.occupied_points(), header));
  const ros::WallTime end = ros::WallTime::now();
  next_wholes_ = end + ros::WallDuration((end - begin).toSec() / kWholesShare);
}

/// Whoever has just joined gets the boxes whole, and so does everybody after a new start: rviz
/// forgets them when the clock jumps back.
void MapPublisher::publishUpdate(const MapSnapshot& snapshot, const std_msgs::Header& header) {
  if (joined_->exchange(false) || snapshot.start != start_) box_updates_.restart();
  start_ = snapshot.start;
  update_.version = snapshot.version;
  const auto markers = box_updates_.next(snapshot.edge_voxels, snapshot.voxel_size, header);
  if (!markers.markers.empty()) update_.publisher.publish(markers);
}

}  // namespace edgevox
