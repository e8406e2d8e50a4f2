// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversions/checked_transforms.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace edgevox {
namespace {

using geometry_msgs::TransformStamped;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kLeap = 100.0;  // [s]

TransformStamped transformAt(double seconds, double x = 0.0) {
  TransformStamped transform;
  transform.header.frame_id = "odom";
  transform.header.stamp = ros::Time(seconds);
  transform.child_frame_id = "base_link";
  transform.transform.translation.x = x;
  transform.transform.rotation.w = 1.0;
  return transform;
}

class CheckedTransformsTest : public testing::Test {
 protected:
  /// Why the transform is refused; empty if it is taken.
  std::string add(const TransformStamped& transform, bool is_static = false) {
    const auto refusal = checked_.add(transform, "/somebody", is_static);
    if (refusal) text_ = refusal->text;
    return refusal ? refusal->reason : "";
  }
  bool holds(double seconds) const {
    return checked_.buffer().canTransform("odom", "base_link", ros::Time(seconds));
  }

  CheckedTransforms checked_{ros::Duration(30.0), kLeap};
  std::string text_;  // of the last refusal
};

TEST_F(CheckedTransformsTest, whatIsNoRigidTransformIsRefused) {
  using Spoil = std::function<void(TransformStamped&)>;
  const std::vector<std::pair<std::string, Spoil>> kinds = {
      {"no_frame", [](auto& t) { t.child_frame_id = ""; }},
      {"no_frame", [](auto& t) { t.header.frame_id = "/"; }},
      {"one_frame", [](auto& t) { t.child_frame_id = "/odom"; }},
      {"bad_translation", [](auto& t) { t.transform.translation.x = kNan; }},
      {"bad_translation", [](auto& t) { t.transform.translation.y = 1.01e8; }},
      {"bad_translation", [](auto& t) { t.transform.translation.z = -1e300; }},
      {"bad_rotation", [](auto& t) { t.transform.rotation.w = 0.0; }},
      {"bad_rotation", [](auto& t) { t.transform.rotation.w = 1.01; }},
      {"bad_rotation", [](auto& t) { t.transform.rotation.x = kNan; }},
      {"bad_stamp", [](auto& t) { t.header.stamp.sec = 4294967267; }},
      {"bad_stamp", [](auto& t) { t.header.stamp.nsec = 1000000000; }},
  };
  for (const bool is_static : {false, true}) {
    for (const auto& [reason, spoil] : kinds) {
      TransformStamped transform = transformAt(10.0);
      spoil(transform);
      EXPECT_EQ(reason, add(transform, is_static));
      EXPECT_NE(std::string::npos, text_.find("by /somebody is refused: ")) << text_;
      EXPECT_NE(std::string::npos, text_.find("; correct what publishes it")) << text_;
    }
  }
  EXPECT_FALSE(holds(10.0));
  EXPECT_EQ("", checked_.staticParentOf("base_link"));
}

TEST_F(CheckedTransformsTest, whatFloatsAndFilesRoundIsTaken) {
  TransformStamped transform = transformAt(10.0, -0.99e8);
  transform.transform.rotation.w = 0.9951;
  EXPECT_EQ("", add(transform));
  EXPECT_TRUE(holds(10.0));
}

TEST_F(CheckedTransformsTest, aStampFarAheadMustBeConfirmed) {
  EXPECT_EQ("", add(transformAt(10.0)));
  EXPECT_EQ("leap", add(transformAt(500.0)));
  EXPECT_EQ("", add(transformAt(10.2)));
  EXPECT_TRUE(holds(10.1)) << "tf2 has dropped all before 500 s";
  EXPECT_EQ("leap", add(transformAt(501.0)));
  EXPECT_EQ("", add(transformAt(501.2)));
  EXPECT_TRUE(holds(501.2));
}

TEST_F(CheckedTransformsTest, aFrameThatMovesIsNotMovedOnByAStaticTransform) {
  EXPECT_EQ("", add(transformAt(10.0)));
  EXPECT_EQ("leap", add(transformAt(500.0), true));
  EXPECT_EQ("", add(transformAt(10.2)));
  EXPECT_TRUE(holds(10.1));
}

TEST_F(CheckedTransformsTest, afterClearTimeBeginsAnew) {
  EXPECT_EQ("", add(transformAt(1000.0)));
  checked_.clear();
  EXPECT_FALSE(holds(1000.0));
  EXPECT_EQ("", add(transformAt(0.0)));  // as a simulator begins
  EXPECT_EQ("", add(transformAt(5000.0)));
  EXPECT_TRUE(holds(5000.0));
}

TEST_F(CheckedTransformsTest, staticParentsAreKnown) {
  TransformStamped mounting = transformAt(0.0);
  mounting.header.frame_id = "/base_link";
  mounting.child_frame_id = "lidar";
  EXPECT_EQ("", add(mounting, true));
  EXPECT_EQ("base_link", checked_.staticParentOf("lidar"));
  EXPECT_EQ("", checked_.staticParentOf("base_link"));
  checked_.clear();
  EXPECT_TRUE(checked_.buffer().canTransform("base_link", "lidar", ros::Time(7.0)));
}

}  // namespace
}  // namespace edgevox
