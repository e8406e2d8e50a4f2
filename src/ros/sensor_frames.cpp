// SPDX-License-Identifier: BSD-3-Clause
#include "ros/sensor_frames.hpp"

#include <geometry_msgs/TransformStamped.h>
#include <tf2/exceptions.h>

#include <utility>

namespace edgevox {
namespace {

/// TF 1 names may begin with a slash, which tf2 refuses.
std::string withoutSlash(const std::string& frame) {
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

Pose poseOf(const geometry_msgs::Transform& transform) {
  const auto& t = transform.translation;
  const auto& q = transform.rotation;
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
  pose.translation() = Eigen::Vector3d(t.x, t.y, t.z);
  return pose;
}

}  // namespace

SensorFrames::SensorFrames(const tf2::BufferCore& buffer, FrameNames names)
    : buffer_(buffer), names_{withoutSlash(names.base), withoutSlash(names.odom)} {}

Transform SensorFrames::mounting(const std::string& sensor_frame, const ros::Time& stamp) const {
  if (names_.base.empty()) return Pose(Pose::Identity());
  return lookUp(names_.base, withoutSlash(sensor_frame), stamp);
}

Transform SensorFrames::odometry(const std::string& sensor_frame, const ros::Time& stamp) const {
  return lookUp(names_.odom, withoutSlash(sensor_frame), stamp);
}

Transform SensorFrames::lookUp(const std::string& target, const std::string& source,
                               const ros::Time& stamp) const {
  try {
    return poseOf(buffer_.lookupTransform(target, source, stamp).transform);
  } catch (const tf2::TransformException& error) {
    return TransformError{"there is no transform from frame '" + source + "' to '" + target +
                          "' at " + std::to_string(stamp.toSec()) + " (" + error.what() +
                          "); check the frame's name and that /tf and /tf_static hold it"};
  }
}

}  // namespace edgevox
