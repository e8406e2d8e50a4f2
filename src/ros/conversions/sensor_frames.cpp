// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversions/sensor_frames.hpp"

#include <geometry_msgs/TransformStamped.h>
#include <tf2/exceptions.h>

#include <utility>

#include "ros/conversions/pose_messages.hpp"

namespace edgevox {

std::string withoutSlash(const std::string& frame) {
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

Transform lookUp(const tf2::BufferCore& buffer, const std::string& target,
                 const std::string& source, const ros::Time& stamp) {
  const std::string from = withoutSlash(source);
  try {
    return poseOf(buffer.lookupTransform(target, from, stamp).transform);
  } catch (const tf2::TransformException& error) {
    return TransformError{"there is no transform from frame '" + from + "' to '" + target +
                          "' at " + std::to_string(stamp.toSec()) + " (" + error.what() +
                          "); check the frame's name and that /tf and /tf_static hold it"};
  }
}

SensorFrames::SensorFrames(const tf2::BufferCore& buffer, FrameNames names)
    : buffer_(buffer), names_{withoutSlash(names.base), withoutSlash(names.odom)} {}

Transform SensorFrames::mounting(const std::string& sensor_frame, const ros::Time& stamp) const {
  if (names_.base.empty()) return Pose(Pose::Identity());
  return lookUp(buffer_, names_.base, sensor_frame, stamp);
}

Transform SensorFrames::odometry(const std::string& sensor_frame, const ros::Time& stamp) const {
  return lookUp(buffer_, names_.odom, sensor_frame, stamp);
}

}  // namespace edgevox
