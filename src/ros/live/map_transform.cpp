// SPDX-License-Identifier: BSD-3-Clause
#include "ros/live/map_transform.hpp"

#include <tf2/exceptions.h>
#include <tf2_msgs/TFMessage.h>

#include <utility>

#include "ros/conversions/pose_messages.hpp"

namespace edgevox {
namespace {

constexpr int kDeepestTree = 100;  // tf2 accepts loops
const ros::WallDuration kPatience(0.3);

}  // namespace

MapTransform::MapTransform(ros::NodeHandle handle, const CheckedTransforms& transforms,
                           std::string map_frame, std::string odom_frame)
    : transforms_(transforms),
      map_frame_(withoutSlash(map_frame)),
      odom_frame_(withoutSlash(odom_frame)),
      publisher_(handle.advertise<tf2_msgs::TFMessage>("/tf", 100)) {
  if (!odom_frame_.empty()) child_ = odom_frame_;
}

bool MapTransform::isReady(const std_msgs::Header& header) const {
  const std::string sensor_frame = withoutSlash(header.frame_id);
  return !odom_frame_.empty() || !child_ || *child_ == sensor_frame ||
         transforms_.buffer().canTransform(*child_, sensor_frame, header.stamp);
}

std::string MapTransform::publish(const std_msgs::Header& header, const ScanResult& scan,
                                  const ScanTransforms& transforms) {
  if (!odom_frame_.empty()) return publishOdometry(header, scan, transforms);
  if (header.frame_id.empty()) {
    return "the clouds' header.frame_id is empty, so the pose cannot go to TF; set it in the "
           "driver";
  }
  if (scan.located()) early_.push_back({header, scan.T_map_sensor});
  if (!chooseChild(withoutSlash(header.frame_id))) return "";
  std::string error;
  for (const Located& located : early_) error = publishRoot(located);
  early_.clear();
  return error;
}

std::string MapTransform::publishOdometry(const std_msgs::Header& header, const ScanResult& scan,
                                          const ScanTransforms& transforms) {
  if (scan.located() && transforms.T_odom_sensor) {
    T_map_odom_ = scan.T_map_sensor * transforms.T_odom_sensor->inverse();
  }
  return T_map_odom_ ? send(*T_map_odom_, header.stamp) : transforms.odometry_error;
}

std::string MapTransform::publishRoot(const Located& located) {
  const Transform T_child_sensor =
      lookUp(transforms_.buffer(), *child_, located.header.frame_id, located.header.stamp);
  if (const auto* error = std::get_if<TransformError>(&T_child_sensor)) return error->text;
  return send(located.T_map_sensor * std::get<Pose>(T_child_sensor).inverse(),
              located.header.stamp);
}

std::string MapTransform::send(const Pose& T_map_child, const ros::Time& stamp) const {
  if (*child_ == map_frame_) {
    return "frame '" + map_frame_ +
           "' is already the root of the sensor's frames, by another node or by a bag; choose "
           "another map_frame, or play the bag without /tf";
  }
  const std::string parent = parentOf(*child_);
  if (!parent.empty() && parent != map_frame_) {
    return "frame '" + *child_ + "' already has the parent '" + parent + "', so '" + map_frame_ +
           "' -> '" + *child_ +
           "' is not published; set odom_frame or base_frame to the robot's frames and start "
           "again, or stop the other publisher";
  }
  if (!T_map_child.matrix().allFinite())
    return "the pose of frame '" + *child_ + "' is not finite; call reset for a new map";
  tf2_msgs::TFMessage message;
  message.transforms.push_back(toMessage(T_map_child, map_frame_, *child_, stamp));
  publisher_.publish(message);
  return "";
}

void MapTransform::reset() {
  T_map_odom_.reset();
  early_.clear();
}

/// False if it is too early to tell.
bool MapTransform::chooseChild(const std::string& sensor_frame) {
  if (child_) return true;
  if (first_.isZero()) first_ = ros::WallTime::now();
  std::string parent = parentOf(sensor_frame);
  if (parent.empty() && ros::WallTime::now() < first_ + kPatience) return false;
  child_ = sensor_frame;
  for (int depth = 0; !parent.empty() && depth < kDeepestTree; ++depth) {
    child_ = parent;
    parent = parentOf(parent);
  }
  return true;
}

/// tf2 ignores a static parent of a frame that it has heard of on /tf: of what is published here.
std::string MapTransform::parentOf(const std::string& frame) const {
  std::string parent = transforms_.staticParentOf(frame);
  if (!parent.empty()) return parent;
  return transforms_.buffer()._getParent(frame, ros::Time(0), parent) ? parent : "";
}

}  // namespace edgevox
