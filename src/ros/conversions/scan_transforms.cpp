// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversions/scan_transforms.hpp"

namespace edgevox {

std::variant<ScanTransforms, ScanRefusal> ScanTransformer::transformsOf(
    const std_msgs::Header& header) {
  const std::string& frame = header.frame_id;
  if (sensor_frame_ && frame != *sensor_frame_) {
    return ScanRefusal{"other_frame",
                       "its frame is '" + frame + "', that of the first scan is '" +
                           *sensor_frame_ +
                           "'; one sensor can be mapped, give its clouds a topic of their own"};
  }
  const Transform mounting = frames_.mounting(frame, header.stamp);
  if (const auto* error = std::get_if<TransformError>(&mounting)) {
    return ScanRefusal{"no_mounting", error->text};
  }
  sensor_frame_ = frame;
  ScanTransforms transforms;
  transforms.T_base_sensor = std::get<Pose>(mounting);
  if (frames_.usesOdometry()) {
    const Transform odometry = frames_.odometry(frame, header.stamp);
    if (const auto* pose = std::get_if<Pose>(&odometry)) {
      transforms.T_odom_sensor = *pose;
    } else {
      transforms.odometry_error = std::get<TransformError>(odometry).text;
    }
  }
  return transforms;
}

bool ScanTransformer::isReady(const std_msgs::Header& header) const {
  const auto is_there = [](const Transform& t) { return std::holds_alternative<Pose>(t); };
  return is_there(frames_.mounting(header.frame_id, header.stamp)) &&
         (!frames_.usesOdometry() || is_there(frames_.odometry(header.frame_id, header.stamp)));
}

}  // namespace edgevox
