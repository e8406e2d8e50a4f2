// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "ros/conversions/box_updates.hpp"
#include "ros/live/map_snapshot.hpp"

namespace edgevox {

/// Publishes the map for whoever listens. Latched and whole, but seldom where that takes long:
/// `map_edges` and `map_occupied` are centroids, `map_boxes` the edge voxels as boxes. At every
/// call: `map_boxes_update`, the boxes that have changed.
class MapPublisher {
 public:
  MapPublisher(ros::NodeHandle handle, std::string map_frame);

  /// Whether there is something to publish of the map of this version.
  bool isDue(uint64_t version) const;
  void publish(const MapSnapshot& snapshot);

 private:
  struct Topic {
    ros::Publisher publisher;
    uint64_t version = 0;  // last published

    bool isDue(uint64_t current) const;
  };

  bool areWholesDue() const { return ros::WallTime::now() >= next_wholes_; }
  bool isUpdateDue(uint64_t version) const;
  void publishWholes(const MapSnapshot& snapshot, const std_msgs::Header& header);
  void publishUpdate(const MapSnapshot& snapshot, const std_msgs::Header& header);

  std::string map_frame_;
  Topic edges_;
  Topic occupied_;
  Topic boxes_;
  ros::WallTime next_wholes_;
  std::shared_ptr<std::atomic<bool>> joined_;  // a listener to the updates, since the last one
  Topic update_;
  BoxUpdates box_updates_;
  uint64_t start_ = 0;  // of the last update
};

}  // namespace edgevox
