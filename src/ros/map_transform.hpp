// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <std_msgs/Header.h>
#include <tf2/buffer_core.h>

#include <optional>
#include <string>

#include "edgevox/mapper.hpp"
#include "ros/scan_transforms.hpp"

namespace edgevox {

/// Publishes the one transform that joins the map's frame to the robot's frames (REP 105): map ->
/// odom if there is an odometry frame; else map -> the root of the sensor's tree, which is the base
/// frame of a robot without odometry. The child is fixed at the first scan. A frame that has
/// another parent is left alone: no frame ever gets two.
class MapTransform {
 public:
  /// `buffer` must outlive this.
  MapTransform(ros::NodeHandle handle, const tf2::BufferCore& buffer, std::string map_frame,
               std::string odom_frame);

  /// Whether TF has all that publish() looks up; before the first scan, whether the sensor's frame
  /// has a parent.
  bool isReady(const std_msgs::Header& header) const;

  /// With the scan's stamp. Without a new pose map -> odom stays as it was, and map -> base is not
  /// published. Why nothing was published where it should have been; else empty.
  std::string publish(const std_msgs::Header& header, const ScanResult& scan,
                      const ScanTransforms& transforms);

  /// Empty before the first scan.
  std::string child() const { return child_.value_or(""); }
  /// Forgets map -> odom; the child stays.
  void reset() { T_map_child_.reset(); }

 private:
  void chooseChild(const std::string& sensor_frame);
  std::string locate(const std_msgs::Header& header, const ScanResult& scan,
                     const ScanTransforms& transforms);
  std::string parentOf(const std::string& frame) const;

  const tf2::BufferCore& buffer_;
  std::string map_frame_;
  std::string odom_frame_;
  std::optional<std::string> child_;
  std::optional<Pose> T_map_child_;
  ros::Publisher publisher_;
};

}  // namespace edgevox
