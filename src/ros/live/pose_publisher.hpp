// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Path.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <std_msgs/Header.h>

#include <optional>
#include <string>

#include "edgevox/mapping/mapper.hpp"
#include "edgevox/ring_buffer.hpp"

namespace edgevox {

/// Publishes poses of the base in the map: `odom` at once, `path` when it is given back.
class PosePublisher {
 public:
  /// `base_frame` empty: the sensor's own frame.
  PosePublisher(ros::NodeHandle handle, std::string map_frame, std::string base_frame,
                int path_length);

  /// Publishes the pose of a located scan; `header` is the scan's. A covariance that is not finite,
  /// as nothing was to be learned in some direction, is published as 1e6 for all. False if the pose
  /// is not finite: nothing was published.
  bool publish(const std_msgs::Header& header, const ScanResult& scan, const Pose& T_base_sensor);
  /// The poses so far, if there are others than at the last call and somebody listens. Poses less
  /// than 5 cm apart are left out.
  std::optional<nav_msgs::Path> takePath();
  /// May be called while the other functions are.
  void publish(const nav_msgs::Path& path) const { path_publisher_.publish(path); }
  void reset();

 private:
  struct Last {
    double stamp;  // [s]
    Pose T_map_base;
    Matrix6 covariance;
  };

  void appendToPath(const geometry_msgs::PoseStamped& pose);

  std::string map_frame_;
  std::string base_frame_;
  std::optional<Last> last_;
  RingBuffer<geometry_msgs::PoseStamped> path_;
  bool path_changed_ = false;
  ros::Publisher odometry_;
  ros::Publisher path_publisher_;
};

}  // namespace edgevox
