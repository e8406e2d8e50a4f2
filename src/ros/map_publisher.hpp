// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/time.h>

#include <cstdint>
#include <string>
#include <vector>

#include "edgevox/map/map_builder.hpp"

namespace edgevox {

/// Publishes the map, latched, for whoever listens: `map_edges` and `map_occupied` are centroids,
/// `map_boxes` the edge voxels as boxes.
class MapPublisher {
 public:
  MapPublisher(ros::NodeHandle handle, std::string map_frame);

  /// What a listener has not got yet, to be taken while the map stands still.
  struct Content {
    std::vector<VoxelIndex> boxes;
    std::vector<Eigen::Vector3f> edges;
    std::vector<Eigen::Vector3f> occupied;
    bool has_boxes = false;
    bool has_edges = false;
    bool has_occupied = false;
  };
  /// `version` differs whenever the map does.
  Content collect(const MapBuilder& map, uint64_t version);
  void publish(const Content& content, double voxel_size, const ros::Time& stamp) const;

 private:
  struct Topic {
    ros::Publisher publisher;
    uint64_t version = 0;  // last published

    bool isDue(uint64_t current) const;
  };

  std::string map_frame_;
  Topic edges_;
  Topic occupied_;
  Topic boxes_;
};

}  // namespace edgevox
