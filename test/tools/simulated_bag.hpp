// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <rosbag/bag.h>
#include <sensor_msgs/PointCloud2.h>

#include <string>
#include <vector>

#include "edgevox/io/trajectory_io.hpp"
#include "sim/scanner.hpp"
#include "tools/cloud_message.hpp"

namespace edgevox::test {

/// The first sweeps of a walk through the simulated building, after the start.
struct SimulatedRun {
  std::vector<sensor_msgs::PointCloud2> clouds;  ///< frame "lidar", with times
  Trajectory truth;                              ///< of the sensor
};

ros::Time stampOf(double seconds);

sensor_msgs::PointCloud2 cloudOf(const sim::Scan& scan);

SimulatedRun simulateRun(int sweeps);

geometry_msgs::TransformStamped transformOf(const std::string& parent, const std::string& child,
                                            const ros::Time& stamp, const Pose& pose);

void writeClouds(rosbag::Bag& bag, const std::string& topic,
                 const std::vector<sensor_msgs::PointCloud2>& clouds);

void writeTransform(rosbag::Bag& bag, const std::string& topic, const ros::Time& received,
                    const geometry_msgs::TransformStamped& transform);

}  // namespace edgevox::test
