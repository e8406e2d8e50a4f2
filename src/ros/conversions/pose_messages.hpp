// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>

#include <string>

#include "edgevox/matching/matcher.hpp"
#include "edgevox/scan/motion.hpp"

namespace edgevox {

geometry_msgs::Pose toMessage(const Pose& pose);
Pose poseOf(const geometry_msgs::Pose& pose);
Pose poseOf(const geometry_msgs::Transform& transform);

geometry_msgs::TransformStamped toMessage(const Pose& T_parent_child, const std::string& parent,
                                          const std::string& child, const ros::Time& stamp);

/// Turns the covariance of a sensor's pose (translation, rotation vector about the sensor, map's
/// axes) into that of the base's, in the same axes.
Matrix6 covarianceOfBase(const Matrix6& covariance, const Pose& T_map_sensor,
                         const Pose& T_base_sensor);

/// `twist` in the child's axes; row-major covariances of (translation, rotation).
nav_msgs::Odometry toMessage(const Pose& T_map_base, const Matrix6& pose_covariance,
                             const Twist& twist, const Matrix6& twist_covariance);

}  // namespace edgevox
