// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversions/pose_messages.hpp"

namespace edgevox {
namespace {

template <typename Message>
void setVector(const Eigen::Vector3d& vector, Message& message) {
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
}

template <typename Message>
void setQuaternion(const Pose& pose, Message& message) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(pose.linear()).normalized();
  message.x = q.x();
  message.y = q.y();
  message.z = q.z();
  message.w = q.w();
}

template <typename Translation, typename Rotation>
Pose poseFrom(const Translation& t, const Rotation& q) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
  pose.translation() = Eigen::Vector3d(t.x, t.y, t.z);
  return pose;
}

template <typename Array>
void setMatrix(const Matrix6& matrix, Array& array) {
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      array[static_cast<size_t>(6 * row + column)] = matrix(row, column);
    }
  }
}

}  // namespace

geometry_msgs::Pose toMessage(const Pose& pose) {
  geometry_msgs::Pose message;
  setVector(pose.translation(), message.position);
  setQuaternion(pose, message.orientation);
  return message;
}

Pose poseOf(const geometry_msgs::Pose& pose) { return poseFrom(pose.position, pose.orientation); }

Pose poseOf(const geometry_msgs::Transform& transform) {
  return poseFrom(transform.translation, transform.rotation);
}

geometry_msgs::TransformStamped toMessage(const Pose& T_parent_child, const std::string& parent,
                                          const std::string& child, const ros::Time& stamp) {
  geometry_msgs::TransformStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = parent;
  message.child_frame_id = child;
  setVector(T_parent_child.translation(), message.transform.translation);
  setQuaternion(T_parent_child, message.transform.rotation);
  return message;
}

Matrix6 covarianceOfBase(const Matrix6& covariance, const Pose& T_map_sensor,
                         const Pose& T_base_sensor) {
  const Eigen::Vector3d arm =
      T_map_sensor.linear() * T_base_sensor.inverse().translation();  // sensor to base
  Matrix6 change = Matrix6::Identity();
  change.topRightCorner<3, 3>() << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
  return change * covariance * change.transpose();
}

nav_msgs::Odometry toMessage(const Pose& T_map_base, const Matrix6& pose_covariance,
                             const Twist& twist, const Matrix6& twist_covariance) {
  nav_msgs::Odometry odometry;
  odometry.pose.pose = toMessage(T_map_base);
  setMatrix(pose_covariance, odometry.pose.covariance);
  setVector(twist.linear, odometry.twist.twist.linear);
  setVector(twist.angular, odometry.twist.twist.angular);
  setMatrix(twist_covariance, odometry.twist.covariance);
  return odometry;
}

}  // namespace edgevox
