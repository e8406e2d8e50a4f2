// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/scan/motion.hpp"

#include <algorithm>

#include <Eigen/Geometry>

namespace edgevox {
namespace {

constexpr double kLongestExtrapolation = 2.0;  // of the motion [s]

}  // namespace

Eigen::Matrix3d rotationOf(const Eigen::Vector3d& v) {
  const double angle = v.norm();
  if (angle < 1e-12) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, v / angle).toRotationMatrix();
}

Eigen::Vector3d rotationVector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd a(Eigen::Quaterniond(rotation).normalized());
  return a.angle() * a.axis();
}

double rotationAngle(const Pose& a_b) { return rotationVector(a_b.linear()).norm(); }

Pose moved(const Twist& twist, double seconds) {
  Pose pose = Pose::Identity();
  pose.linear() = rotationOf(twist.angular * seconds);
  pose.translation() = twist.linear * seconds;
  return pose;
}

Pose extrapolated(const Twist& twist, double seconds) {
  return moved(twist, std::clamp(seconds, -kLongestExtrapolation, kLongestExtrapolation));
}

Twist twistOf(const Pose& T_from_to, double seconds) {
  return {T_from_to.translation() / seconds, rotationVector(T_from_to.linear()) / seconds};
}

void renormalise(Pose& pose) {
  pose.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
}

}  // namespace edgevox
