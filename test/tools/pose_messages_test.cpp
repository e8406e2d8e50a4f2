// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversions/pose_messages.hpp"

#include <gtest/gtest.h>

#include "support/random.hpp"

namespace edgevox {
namespace {

Pose makePose(const Eigen::Vector3d& axis, double angle, const Eigen::Vector3d& translation) {
  Pose pose(Eigen::AngleAxisd(angle, axis.normalized()));
  pose.translation() = translation;
  return pose;
}

/// Moves and turns the sensor a little, in the map's axes, about the sensor.
Pose disturbed(const Pose& T_map_sensor, const Eigen::Matrix<double, 6, 1>& change) {
  Pose result = T_map_sensor;
  result.linear() = rotationOf(change.tail<3>()) * T_map_sensor.linear();
  result.translation() += change.head<3>();
  return result;
}

TEST(CovarianceOfBase, isTheScatterOfItsPoses) {
  const Pose T_map_sensor = makePose({1, 2, -1}, 0.8, {3, -2, 5});
  const Pose T_base_sensor = makePose({0.2, -1, 1}, -1.1, {0.5, -0.8, 1.4});
  test::Random random(1);
  Matrix6 root;
  for (int i = 0; i < 36; ++i) root(i / 6, i % 6) = random.uniform(-1, 1);
  const Matrix6 covariance = 1e-6 * root * root.transpose();
  const Matrix6 of_base = covarianceOfBase(covariance, T_map_sensor, T_base_sensor);

  // The derivative of the base's pose by differences gives the same.
  const Pose T_map_base = T_map_sensor * T_base_sensor.inverse();
  Matrix6 derivative;
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 6; ++i) {
    Eigen::Matrix<double, 6, 1> change = Eigen::Matrix<double, 6, 1>::Zero();
    change[i] = kStep;
    const Pose moved_base = disturbed(T_map_sensor, change) * T_base_sensor.inverse();
    derivative.col(i).head<3>() = (moved_base.translation() - T_map_base.translation()) / kStep;
    derivative.col(i).tail<3>() =
        rotationVector(moved_base.linear() * T_map_base.linear().transpose()) / kStep;
  }
  const Matrix6 expected = derivative * covariance * derivative.transpose();
  EXPECT_LT((of_base - expected).norm(), 1e-4 * expected.norm());
  EXPECT_GT((of_base - covariance).norm(), 0.1 * covariance.norm());
  EXPECT_EQ(covariance, covarianceOfBase(covariance, T_map_sensor, Pose::Identity()));
}

TEST(TransformMessage, givesThePoseBack) {
  const Pose pose = makePose({1, -2, 0.3}, 2.9, {1e3, -2, 0.001});
  const auto message = toMessage(pose, "map", "base_link", ros::Time(5, 7));
  EXPECT_EQ("map", message.header.frame_id);
  EXPECT_EQ("base_link", message.child_frame_id);
  EXPECT_EQ(ros::Time(5, 7), message.header.stamp);
  EXPECT_TRUE(poseOf(message.transform).isApprox(pose, 1e-12));
}

TEST(OdometryMessage, isRowMajor) {
  Matrix6 covariance;
  for (int i = 0; i < 36; ++i) covariance(i / 6, i % 6) = i;
  const auto odometry =
      toMessage(Pose::Identity(), covariance, {{1, 2, 3}, {4, 5, 6}}, 2 * covariance);
  for (size_t i = 0; i < 36; ++i) {
    EXPECT_EQ(static_cast<double>(i), odometry.pose.covariance[i]);
    EXPECT_EQ(static_cast<double>(2 * i), odometry.twist.covariance[i]);
  }
  EXPECT_EQ(3.0, odometry.twist.twist.linear.z);
  EXPECT_EQ(4.0, odometry.twist.twist.angular.x);
}

}  // namespace
}  // namespace edgevox
