// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <std_msgs/Header.h>

#include <optional>
#include <string>
#include <vector>

#include "edgevox/mapping/mapper.hpp"
#include "ros/conversions/checked_transforms.hpp"
#include "ros/conversions/scan_transforms.hpp"

namespace edgevox {

/// Publishes the one transform that joins the map's frame to the robot's frames (REP 105): map ->
/// odom if there is an odometry frame; else map -> the root of the sensor's tree, which is the base
/// frame of a robot without odometry. The child is fixed at the first scan or, if TF does not know
/// the sensor's frame yet, after a short while, when the transforms until then are published. A
/// frame that has another parent is left alone: no frame ever gets two.
class MapTransform {
 public:
  /// `transforms` must outlive this.
  MapTransform(ros::NodeHandle handle, const CheckedTransforms& transforms, std::string map_frame,
               std::string odom_frame);

  /// Whether TF has all that publish() looks up.
  bool isReady(const std_msgs::Header& header) const;

  /// Publishes with the scan's stamp. Without a new pose map -> odom stays as it was, and map ->
  /// base is not published. The text says why nothing was published where it should have been; else
  /// it is empty.
  std::string publish(const std_msgs::Header& header, const ScanResult& scan,
                      const ScanTransforms& transforms);

  /// Empty before the first scan.
  std::string child() const { return child_.value_or(""); }
  /// Forgets map -> odom; the child stays.
  void reset();

 private:
  /// A located scan.
  struct Located {
    std_msgs::Header header;
    Pose T_map_sensor;
  };

  bool chooseChild(const std::string& sensor_frame);
  std::string publishRoot(const Located& located);
  std::string publishOdometry(const std_msgs::Header& header, const ScanResult& scan,
                              const ScanTransforms& transforms);
  std::string send(const Pose& T_map_child, const ros::Time& stamp) const;
  std::string parentOf(const std::string& frame) const;

  const CheckedTransforms& transforms_;
  std::string map_frame_;
  std::string odom_frame_;
  std::optional<std::string> child_;
  std::optional<Pose> T_map_odom_;
  std::vector<Located> early_;  // before the child was known
  ros::WallTime first_;         // scan
  ros::Publisher publisher_;
};

}  // namespace edgevox
