// SPDX-License-Identifier: BSD-3-Clause
#include "ros/map_transform.hpp"

#include <tf2/exceptions.h>
#include <tf2_msgs/TFMessage.h>

#include <utility>

#include "ros/pose_messages.hpp"

namespace edgevox {
namespace {

constexpr int kDeepestTree = 100;  // tf2 accepts loops

}  // namespace

MapTransform::MapTransform(ros::NodeHandle handle, const tf2::BufferCore& buffer,
                           std::string map_frame, std::string odom_frame)
    : buffer_(buffer),
      map_frame_(withoutSlash(map_frame)),
      odom_frame_(withoutSlash(odom_frame)),
      publisher_(handle.advertise<tf2_msgs::TFMessage>("/tf", 100)) {
  if (!odom_frame_.empty()) child_ = odom_frame_;
}

bool MapTransform::isReady(const std_msgs::Header& header) const {
  if (!odom_frame_.empty()) return true;
  const std::string sensor_frame = withoutSlash(header.frame_id);
  if (!child_) return !parentOf(sensor_frame).empty();
  return *child_ == sensor_frame || buffer_.canTransform(*child_, sensor_frame, header.stamp);
}

std::string MapTransform::publish(const std_msgs::Header& header, const ScanResult& scan,
                                  const ScanTransforms& transforms) {
  if (header.frame_id.empty()) {
    return "the clouds' header.frame_id is empty, so the pose cannot go to TF; set it in the "
           "driver";
  }
  chooseChild(withoutSlash(header.frame_id));
  const std::string error = locate(header, scan, transforms);
  if (!error.empty() || !T_map_child_) return error;
  const std::string parent = parentOf(*child_);
  if (!parent.empty() && parent != map_frame_) {
    return "frame '" + *child_ + "' already has the parent '" + parent + "', so '" + map_frame_ +
           "' -> '" + *child_ + "' is not published; set odom_frame or base_frame to the robot's " +
           "frames and start again, or stop the other publisher";
  }
  if (*child_ == map_frame_) {
    return "frame '" + map_frame_ +
           "' is already the root of the sensor's frames, published by "
           "another node or by a bag; choose another map_frame, or play the bag without /tf";
  }
  tf2_msgs::TFMessage message;
  message.transforms.push_back(toMessage(*T_map_child_, map_frame_, *child_, header.stamp));
  publisher_.publish(message);
  return "";
}

void MapTransform::chooseChild(const std::string& sensor_frame) {
  if (child_) return;
  child_ = sensor_frame;
  std::string parent = parentOf(sensor_frame);
  for (int depth = 0; !parent.empty() && depth < kDeepestTree; ++depth) {
    child_ = parent;
    parent = parentOf(parent);
  }
}

std::string MapTransform::locate(const std_msgs::Header& header, const ScanResult& scan,
                                 const ScanTransforms& transforms) {
  if (!odom_frame_.empty()) {
    if (!scan.located()) return "";
    if (transforms.T_odom_sensor) {
      T_map_child_ = scan.T_map_sensor * transforms.T_odom_sensor->inverse();
    }
    return transforms.odometry_error;
  }
  T_map_child_.reset();
  if (!scan.located()) return "";
  const Transform T_child_sensor = lookUp(buffer_, *child_, header.frame_id, header.stamp);
  if (const auto* error = std::get_if<TransformError>(&T_child_sensor)) return error->text;
  T_map_child_ = scan.T_map_sensor * std::get<Pose>(T_child_sensor).inverse();
  return "";
}

std::string MapTransform::parentOf(const std::string& frame) const {
  std::string parent;
  return buffer_._getParent(frame, ros::Time(0), parent) ? parent : "";
}

}  // namespace edgevox
