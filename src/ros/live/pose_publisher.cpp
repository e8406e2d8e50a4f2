// SPDX-License-Identifier: BSD-3-Clause
#include "ros/live/pose_publisher.hpp"

#include <nav_msgs/Odometry.h>

#include <utility>

#include "ros/conversions/pose_messages.hpp"
#include "ros/conversions/sensor_frames.hpp"

namespace edgevox {
namespace {

constexpr double kPathStep = 0.05;       // [m]
constexpr double kLeastInterval = 1e-3;  // for a velocity [s]
constexpr double kUnknown = 1e6;         // a variance

double distance(const geometry_msgs::PoseStamped& a, const geometry_msgs::PoseStamped& b) {
  const auto& p = a.pose.position;
  const auto& q = b.pose.position;
  return Eigen::Vector3d(p.x - q.x, p.y - q.y, p.z - q.z).norm();
}

/// The covariance of a velocity from two poses `seconds` apart, in the axes of the second.
Matrix6 twistCovariance(const Matrix6& a, const Matrix6& b, const Pose& pose, double seconds) {
  Matrix6 to_body = Matrix6::Zero();
  to_body.topLeftCorner<3, 3>() = pose.linear().transpose();
  to_body.bottomRightCorner<3, 3>() = pose.linear().transpose();
  return to_body * (a + b) * to_body.transpose() / (seconds * seconds);
}

Matrix6 finite(const Matrix6& covariance) {
  return covariance.allFinite() ? covariance : Matrix6(kUnknown * Matrix6::Identity());
}

}  // namespace

PosePublisher::PosePublisher(ros::NodeHandle handle, std::string map_frame, std::string base_frame,
                             int path_length)
    : map_frame_(withoutSlash(map_frame)),
      base_frame_(withoutSlash(base_frame)),
      path_(static_cast<size_t>(path_length)),
      odometry_(handle.advertise<nav_msgs::Odometry>("odom", 100)),
      path_publisher_(handle.advertise<nav_msgs::Path>("path", 1, true)) {}

bool PosePublisher::publish(const std_msgs::Header& header, const ScanResult& scan,
                            const Pose& T_base_sensor) {
  const Pose T_map_base = scan.T_map_sensor * T_base_sensor.inverse();
  if (!T_map_base.matrix().allFinite()) return false;
  const Matrix6 covariance =
      finite(covarianceOfBase(scan.covariance, scan.T_map_sensor, T_base_sensor));
  Twist twist;
  Matrix6 twist_covariance = Matrix6::Zero();
  if (last_ && scan.stamp >= last_->stamp + kLeastInterval) {
    const double seconds = scan.stamp - last_->stamp;
    twist = twistOf(last_->T_map_base.inverse() * T_map_base, seconds);
    twist_covariance = twistCovariance(last_->covariance, covariance, T_map_base, seconds);
  }
  last_ = Last{scan.stamp, T_map_base, covariance};

  nav_msgs::Odometry odometry = toMessage(T_map_base, covariance, twist, twist_covariance);
  odometry.header.stamp = header.stamp;
  odometry.header.frame_id = map_frame_;
  odometry.child_frame_id = base_frame_.empty() ? withoutSlash(header.frame_id) : base_frame_;
  odometry_.publish(odometry);

  geometry_msgs::PoseStamped pose;
  pose.header = odometry.header;
  pose.pose = odometry.pose.pose;
  appendToPath(pose);
  return true;
}

void PosePublisher::appendToPath(const geometry_msgs::PoseStamped& pose) {
  if (!path_.empty() && distance(path_.newest(), pose) < kPathStep) return;
  path_.push(pose);
  path_changed_ = true;
}

std::optional<nav_msgs::Path> PosePublisher::takePath() {
  if (!path_changed_ || path_publisher_.getNumSubscribers() == 0) return std::nullopt;
  nav_msgs::Path path;
  path.header.frame_id = map_frame_;
  if (!path_.empty()) path.header.stamp = path_.newest().header.stamp;
  path.poses.reserve(path_.size());
  for (size_t i = 0; i < path_.size(); ++i) path.poses.push_back(path_[i]);
  path_changed_ = false;
  return path;
}

void PosePublisher::reset() {
  last_.reset();
  path_.clear();
  path_changed_ = true;
}

}  // namespace edgevox
