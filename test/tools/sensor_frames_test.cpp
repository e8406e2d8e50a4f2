// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversions/sensor_frames.hpp"

#include <geometry_msgs/TransformStamped.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace edgevox {
namespace {

geometry_msgs::TransformStamped makeTransform(const std::string& parent, const std::string& child,
                                              double stamp, double x, double yaw) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = parent;
  transform.header.stamp = ros::Time(stamp);
  transform.child_frame_id = child;
  transform.transform.translation.x = x;
  transform.transform.rotation.z = std::sin(yaw / 2);
  transform.transform.rotation.w = std::cos(yaw / 2);
  return transform;
}

class SensorFramesTest : public testing::Test {
 protected:
  SensorFramesTest() {
    buffer_.setTransform(makeTransform("base_link", "lidar", 0, 0.5, M_PI / 2), "test", true);
    buffer_.setTransform(makeTransform("odom", "base_link", 100, 1, 0), "test", false);
    buffer_.setTransform(makeTransform("odom", "base_link", 102, 3, 0), "test", false);
  }

  static void expectPose(const Transform& transform, double x, double yaw) {
    ASSERT_TRUE(std::holds_alternative<Pose>(transform))
        << std::get<TransformError>(transform).text;
    const Pose& pose = std::get<Pose>(transform);
    EXPECT_LT((pose.translation() - Eigen::Vector3d(x, 0, 0)).norm(), 1e-9);
    const Eigen::Vector3d forward(std::cos(yaw), std::sin(yaw), 0);
    EXPECT_LT((pose.linear() * Eigen::Vector3d::UnitX() - forward).norm(), 1e-9);
  }

  static void expectError(const Transform& transform, const std::string& words) {
    ASSERT_TRUE(std::holds_alternative<TransformError>(transform));
    const std::string& text = std::get<TransformError>(transform).text;
    EXPECT_NE(text.find(words), std::string::npos) << text;
  }

  tf2::BufferCore buffer_;
};

TEST_F(SensorFramesTest, withoutFramesTheSensorIsTheBody) {
  const SensorFrames frames(buffer_, {});
  EXPECT_FALSE(frames.usesOdometry());
  expectPose(frames.mounting("anything", ros::Time(5)), 0, 0);
}

TEST_F(SensorFramesTest, mountingAndOdometry) {
  const SensorFrames frames(buffer_, {"base_link", "odom"});
  EXPECT_TRUE(frames.usesOdometry());
  expectPose(frames.mounting("lidar", ros::Time(100.5)), 0.5, M_PI / 2);
  expectPose(frames.odometry("lidar", ros::Time(100.5)), 2.0, M_PI / 2);
}

TEST_F(SensorFramesTest, slashesOfTheFirstTf) {
  const SensorFrames frames(buffer_, {"/base_link", "/odom"});
  expectPose(frames.mounting("/lidar", ros::Time(101)), 0.5, M_PI / 2);
  expectPose(frames.odometry("/lidar", ros::Time(101)), 2.5, M_PI / 2);
}

TEST_F(SensorFramesTest, missingTransformsAreErrors) {
  const SensorFrames frames(buffer_, {"base_link", "odom"});
  expectError(frames.mounting("camera", ros::Time(101)), "from frame 'camera' to 'base_link'");
  expectError(frames.mounting("", ros::Time(101)), "to 'base_link'");
  expectError(frames.odometry("lidar", ros::Time(103)), "at 103.0");
  expectError(frames.odometry("lidar", ros::Time(99)), "/tf");
  expectError(SensorFrames(buffer_, {"chassis", ""}).mounting("lidar", ros::Time(101)),
              "to 'chassis'");
}

}  // namespace
}  // namespace edgevox
