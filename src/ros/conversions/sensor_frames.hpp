// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/time.h>
#include <tf2/buffer_core.h>

#include <string>
#include <variant>

#include "edgevox/grid/voxel.hpp"

namespace edgevox {

/// Names after REP 105; an empty one is not used.
struct FrameNames {
  std::string base;  ///< the body whose trajectory is asked for; empty: the sensor itself
  std::string odom;  ///< the smooth frame that predictions come from; empty: constant velocity
};

struct TransformError {
  std::string text;  ///< what is missing, what tf2 says, and what to do
};

using Transform = std::variant<Pose, TransformError>;

/// TF 1 names may begin with a slash, which tf2 refuses.
std::string withoutSlash(const std::string& frame);

/// T_target_source at the stamp.
Transform lookUp(const tf2::BufferCore& buffer, const std::string& target,
                 const std::string& source, const ros::Time& stamp);

/// What a mapper needs to know from TF about a scan. A transform that is not there is an error,
/// never the identity.
class SensorFrames {
 public:
  /// `buffer` must outlive this.
  SensorFrames(const tf2::BufferCore& buffer, FrameNames names);

  bool usesOdometry() const { return !names_.odom.empty(); }

  /// T_base_sensor at the stamp; the identity if no base frame is used.
  Transform mounting(const std::string& sensor_frame, const ros::Time& stamp) const;
  /// T_odom_sensor at the stamp. Requires usesOdometry().
  Transform odometry(const std::string& sensor_frame, const ros::Time& stamp) const;

 private:
  const tf2::BufferCore& buffer_;
  FrameNames names_;
};

}  // namespace edgevox
