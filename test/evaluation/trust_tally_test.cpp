// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/trust_tally.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "edgevox/scan/motion.hpp"

namespace edgevox {
namespace {

Pose poseOf(double x, double y, double degrees) {
  Pose pose = Pose::Identity();
  pose.translation() << x, y, 0.3;
  pose.linear() = rotationOf({0.0, 0.0, degrees * M_PI / 180.0});
  return pose;
}

/// The true pose number i of a walk around a corner.
Pose truthAt(int i) { return poseOf(5.0 + i, -2.0 + 0.1 * i * i, 30.0 + 5.0 * i); }

ScanResult scanOf(ScanStatus status, const Pose& T_map_sensor) {
  ScanResult scan;
  scan.status = status;
  scan.T_map_sensor = T_map_sensor;
  return scan;
}

class TrustTallyTest : public ::testing::Test {
 protected:
  /// The map frame is the sensor's at the first scan.
  TrustTallyTest() { add(ScanStatus::kFirst, Pose::Identity()); }

  /// A scan that is located `off` its true pose, in the sensor's frame.
  void add(ScanStatus status, const Pose& off) {
    const Pose truth = truthAt(number_++);
    tally_.add(scanOf(status, truthAt(0).inverse() * truth * off), truth);
  }

  int number_ = 0;
  TrustTally tally_;
};

TEST_F(TrustTallyTest, CountsRightWrongAndLost) {
  add(ScanStatus::kTracked, Pose::Identity());
  add(ScanStatus::kTracked, poseOf(0.2, 0.0, 4.0));
  add(ScanStatus::kFallback, poseOf(0.0, -0.6, 0.0));
  add(ScanStatus::kTracked, poseOf(0.0, 0.0, 6.0));
  add(ScanStatus::kLost, Pose::Identity());
  add(ScanStatus::kStale, poseOf(9.0, 0.0, 0.0));
  add(ScanStatus::kTooFew, Pose::Identity());
  const TrustCounts& counts = tally_.counts();
  EXPECT_EQ(counts.right, 3U);
  EXPECT_EQ(counts.wrong, 2U);
  EXPECT_EQ(counts.lost, 3U);
  EXPECT_EQ(counts.scans(), 8U);
  EXPECT_EQ(counts.located(), 5U);
  EXPECT_EQ(counts.count(ScanStatus::kFallback), 1U);
  EXPECT_EQ(counts.count(ScanStatus::kStale), 1U);
  EXPECT_EQ(counts.count(ScanStatus::kTooLarge), 0U);
}

TEST_F(TrustTallyTest, ErrorsAreOfRightOnesTheFarthestOfAll) {
  add(ScanStatus::kTracked, poseOf(0.4, 0.0, 0.0));
  add(ScanStatus::kTracked, poseOf(0.0, 3.0, 0.0));
  add(ScanStatus::kLost, poseOf(7.0, 0.0, 0.0));
  const TrustCounts& counts = tally_.counts();
  ASSERT_EQ(counts.right_distances.size(), 2U);
  EXPECT_NEAR(counts.right_distances[0], 0.0, 1e-9);
  EXPECT_NEAR(counts.right_distances[1], std::hypot(0.4, 0.3), 1e-9);
  EXPECT_NEAR(counts.farthest, std::hypot(3.0, 0.3), 1e-9);
}

TEST_F(TrustTallyTest, LeavesOutWhatHasNoTruth) {
  tally_.add(scanOf(ScanStatus::kTracked, poseOf(50.0, 0.0, 0.0)), std::nullopt);
  tally_.add(scanOf(ScanStatus::kLost, Pose::Identity()), std::nullopt);
  EXPECT_EQ(tally_.counts().unknown, 2U);
  EXPECT_EQ(tally_.counts().scans(), 1U);
  EXPECT_EQ(tally_.counts().count(ScanStatus::kLost), 0U);
}

TEST_F(TrustTallyTest, CountsAddUp) {
  add(ScanStatus::kFallback, poseOf(0.0, 3.0, 0.0));
  TrustCounts sum = tally_.counts();
  sum += tally_.counts();
  EXPECT_EQ(sum.right, 2U);
  EXPECT_EQ(sum.wrong, 2U);
  EXPECT_EQ(sum.count(ScanStatus::kFallback), 2U);
  EXPECT_EQ(sum.right_distances.size(), 2U);
  EXPECT_EQ(sum.farthest, tally_.counts().farthest);
}

TEST(TrustTally, TheFirstLocatedPoseIsTheReference) {
  TrustTally tally;
  tally.add(scanOf(ScanStatus::kTooFew, Pose::Identity()), truthAt(0));
  tally.add(scanOf(ScanStatus::kFirst, Pose::Identity()), truthAt(3));
  tally.add(scanOf(ScanStatus::kTracked, truthAt(3).inverse() * truthAt(5)), truthAt(5));
  EXPECT_EQ(tally.counts().right, 2U);
  EXPECT_EQ(tally.counts().lost, 1U);
}

}  // namespace
}  // namespace edgevox
