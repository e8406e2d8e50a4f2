// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/io/trajectory_evaluation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "edgevox/scan/motion.hpp"
#include "edgevox/statistics.hpp"
#include "support/random.hpp"

namespace edgevox {
namespace {

constexpr double kDegree = M_PI / 180.0;

Pose poseOf(const Eigen::Vector3d& translation, const Eigen::Vector3d& rotation) {
  Pose pose = Pose::Identity();
  pose.linear() = rotationOf(rotation);
  pose.translation() = translation;
  return pose;
}

/// From a start, `count` poses each a step further; stamps 0.1 s apart.
Trajectory walk(const Pose& step, size_t count) {
  Trajectory trajectory(count);
  for (size_t i = 0; i < count; ++i) {
    trajectory[i].stamp = 1600000000.0 + 0.1 * static_cast<double>(i);
    if (i > 0) trajectory[i].pose = trajectory[i - 1].pose * step;
  }
  return trajectory;
}

Trajectory curve() { return walk(poseOf({0.5, 0, 0.1}, {0.02, 0.1, -0.05}), 60); }

Trajectory moved(const Trajectory& trajectory, const Pose& T) {
  Trajectory result = trajectory;
  for (StampedPose& stamped : result) stamped.pose = T * stamped.pose;
  return result;
}

Trajectory still(size_t count) { return walk(Pose::Identity(), count); }

TEST(Quantile, interpolatesBetweenValues) {
  EXPECT_EQ(quantile({3, 1, 2}, 0.5), 2);
  EXPECT_EQ(quantile({4, 1, 2, 3}, 0.5), 2.5);
  EXPECT_EQ(quantile({5}, 0.95), 5);
  EXPECT_EQ(quantile({1, 2}, 1.0), 2);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
  EXPECT_TRUE(std::isnan(mean({})));
  EXPECT_DOUBLE_EQ(rootMeanSquare({3, 4}), std::sqrt(12.5));
}

TEST(MatchStamps, takesTheNearestWithinFiveMilliseconds) {
  Trajectory reference = still(5);  // at 0, .1, .2, .3, .4 s
  Trajectory estimate = still(5);
  estimate[0].stamp += 0.004;
  estimate[1].stamp -= 0.004;
  estimate[2].stamp += 0.006;
  estimate[3].stamp -= 0.05;
  const auto matches = matchStamps(estimate, reference);
  ASSERT_EQ(matches.size(), 3U);
  EXPECT_EQ(matches[0].reference, 0U);
  EXPECT_EQ(matches[1].reference, 1U);
  EXPECT_EQ(matches[2].estimate, 4U);
  EXPECT_EQ(matches[2].reference, 4U);
}

TEST(MatchStamps, beforeAndAfterTheReference) {
  const Trajectory reference = still(3);
  Trajectory estimate = still(2);
  estimate[0].stamp -= 1.0;
  estimate[1].stamp += 1.0;
  EXPECT_TRUE(matchStamps(estimate, reference).empty());
  EXPECT_TRUE(matchStamps(estimate, {}).empty());
}

TEST(Evaluate, rigidlyMovedTrajectoryHasNoError) {
  test::Random random(3);
  for (int i = 0; i < 20; ++i) {
    Pose T = Pose::Identity();
    T.linear() = random.rotation();
    T.translation() = random.vectorIn(-50, 50);
    const TrajectoryErrors errors = evaluate(moved(curve(), T), curve());
    EXPECT_LT(errors.ape_rmse_m, 1e-9);
    EXPECT_LT(errors.ape_rmse_deg, 1e-5);
    EXPECT_LT(errors.moving.p95_m, 1e-9);
    EXPECT_EQ(errors.poses.size(), 60U);
    EXPECT_EQ(errors.moving.pairs, 59U);
    EXPECT_EQ(errors.standing.pairs, 0U);
    EXPECT_TRUE(std::isnan(errors.standing.median_m));
  }
}

TEST(Evaluate, rotationAroundAStraightLineIsSettledByOrientations) {
  const Trajectory line = walk(poseOf({0.5, 0, 0}, {0, 0, 0}), 20);
  const Pose T = poseOf({1, 2, 3}, {0.9, 0.2, 0.4});
  const TrajectoryErrors errors = evaluate(moved(line, T), line);
  EXPECT_LT(errors.ape_rmse_m, 1e-9);
  EXPECT_LT(errors.ape_rmse_deg, 1e-5);
}

TEST(Evaluate, scaleIsNotAligned) {
  Trajectory estimate = walk(poseOf({0.55, 0, 0}, {0, 0, 0}), 21);
  const TrajectoryErrors errors = evaluate(estimate, walk(poseOf({0.5, 0, 0}, {0, 0, 0}), 21));
  // Residuals are 0.05 (i - 10), i = 0 .. 20: the root mean square of -10 .. 10 is sqrt(770 / 21).
  EXPECT_NEAR(errors.ape_rmse_m, 0.05 * std::sqrt(770.0 / 21.0), 1e-9);
  EXPECT_NEAR(errors.moving.median_m, 0.05, 1e-9);
}

TEST(Evaluate, constantErrorOfEachStep) {
  const Pose step = poseOf({0.5, 0.1, 0}, {0, 0, 0.1});
  const Pose error = poseOf({0.003, -0.004, 0}, {0, 0, 0.2 * kDegree});
  const TrajectoryErrors errors = evaluate(walk(step * error, 30), walk(step, 30));
  EXPECT_NEAR(errors.moving.median_m, 0.005, 1e-9);
  EXPECT_NEAR(errors.moving.p95_m, 0.005, 1e-9);
  EXPECT_NEAR(errors.moving.median_deg, 0.2, 1e-6);
  EXPECT_NEAR(errors.moving.p95_deg, 0.2, 1e-6);
  EXPECT_TRUE(std::isnan(errors.poses.front().rpe_m));
}

TEST(Evaluate, rotationErrorShowsInTheRelativeTranslation) {
  // inv(ref) * est for est = rot(a) * ref is not only a rotation: the step is swung by a.
  const Pose step = poseOf({2, 0, 0}, {0, 0, 0});
  const Pose swing = poseOf({0, 0, 0}, {0, 0, 1.0 * kDegree});
  const TrajectoryErrors errors = evaluate(walk(swing * step, 10), walk(step, 10));
  EXPECT_NEAR(errors.moving.median_m, 2 * 2 * std::sin(0.5 * kDegree), 1e-9);
  EXPECT_NEAR(errors.moving.median_deg, 1.0, 1e-6);
}

TEST(Evaluate, movingAndStandingPairsApart) {
  Trajectory reference = still(7);
  for (size_t i = 3; i < 7; ++i) reference[i].pose.translation().x() = 0.06;
  for (size_t i = 5; i < 7; ++i) reference[i].pose.linear() = rotationOf({0, 0, 0.6 * kDegree});
  Trajectory estimate = reference;
  estimate[3].pose.translation().x() += 0.02;
  for (size_t i = 4; i < 7; ++i) estimate[i].pose.translation().x() += 0.03;
  const TrajectoryErrors errors = evaluate(estimate, reference);
  EXPECT_EQ(errors.moving.pairs, 2U);  // to 3 and to 5
  EXPECT_EQ(errors.standing.pairs, 4U);
  EXPECT_TRUE(errors.poses[3].moving);
  EXPECT_TRUE(errors.poses[5].moving);
  EXPECT_NEAR(errors.moving.median_m, 0.01, 1e-9);
  EXPECT_NEAR(errors.standing.median_m, 0.0, 1e-9);
  EXPECT_NEAR(errors.poses[4].rpe_m, 0.01, 1e-9);
}

TEST(Evaluate, absoluteRotationError) {
  Trajectory estimate = curve();
  for (StampedPose& stamped : estimate) {
    stamped.pose.linear() = stamped.pose.linear() * rotationOf({0, 0, 0.5 * kDegree});
  }
  const TrajectoryErrors errors = evaluate(estimate, curve());
  EXPECT_NEAR(errors.ape_rmse_deg, 0.5, 1e-3);
  EXPECT_LT(errors.ape_rmse_m, 1e-4);
}

TEST(Evaluate, roundedStampsStillMatch) {
  Trajectory rounded = curve();
  for (StampedPose& stamped : rounded) stamped.stamp = std::round(stamped.stamp * 1e3) * 1e-3;
  EXPECT_EQ(evaluate(rounded, curve()).poses.size(), 60U);
}

TEST(Evaluate, tooFewMatchesAreAnError) {
  Trajectory reference = curve();
  for (StampedPose& stamped : reference) stamped.stamp += 1000.0;
  try {
    evaluate(curve(), reference);
    FAIL();
  } catch (const TrajectoryError& error) {
    EXPECT_NE(std::string(error.what()).find("only 0 of 60 poses"), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(evaluate(still(2), curve()), TrajectoryError);
  EXPECT_THROW(evaluate({}, curve()), TrajectoryError);
}

}  // namespace
}  // namespace edgevox
