// SPDX-License-Identifier: BSD-3-Clause
// Which steps of an odometry are believed, and what is made of the others.
#include "edgevox/tracking/odometry_watch.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "edgevox/archive.hpp"
#include "support/sweeps.hpp"

namespace edgevox::test {
namespace {

constexpr double kSpeed = 40.0;                 // [m/s]
constexpr double kTurn = 180.0 * M_PI / 180.0;  // [rad/s]
constexpr double kPeriod = 0.1;                 // [s]
const Twist kVelocity{{2.0, 0.1, 0.0}, {0.0, 0.0, 0.3}};

Pose translated(double x, double y = 0.0, double z = 0.0) {
  return Pose(Eigen::Translation3d(x, y, z));
}

Pose turned(double degrees) {
  return Pose(Eigen::AngleAxisd(degrees * M_PI / 180.0, Eigen::Vector3d::UnitZ()));
}

/// A walk at kVelocity, seen in a frame of its own.
class Walker {
 public:
  explicit Walker(const Pose& T_odom_start = Pose::Identity()) : T_odom_sensor_(T_odom_start) {}

  /// The next scan's.
  bool step(OdometryWatch& watch, const Pose& by = moved(kVelocity, kPeriod)) {
    stamp_ += kPeriod;
    T_odom_sensor_ = T_odom_sensor_ * by;
    return watch.add(stamp_, T_odom_sensor_);
  }
  bool without(OdometryWatch& watch) {
    stamp_ += kPeriod;
    T_odom_sensor_ = T_odom_sensor_ * moved(kVelocity, kPeriod);
    return watch.add(stamp_, std::nullopt);
  }
  void jumpBy(const Pose& jump) { T_odom_sensor_ = jump * T_odom_sensor_; }

  double stamp_ = 1000.0;  // [s]
  Pose T_odom_sensor_;
};

/// After two located scans.
OdometryWatch watchOf(Walker& walker) {
  OdometryWatch watch(kSpeed, kTurn);
  for (int i = 0; i < 2; ++i) {
    EXPECT_TRUE(walker.step(watch));
    watch.located(std::nullopt);
  }
  return watch;
}

void expectSince(const OdometryWatch& watch, int steps, double metres = 1e-9) {
  Pose expected = Pose::Identity();
  for (int i = 0; i < steps; ++i) expected = expected * moved(kVelocity, kPeriod);
  ASSERT_TRUE(watch.sinceLocated());
  const PoseDifference error = differenceOf(expected, *watch.sinceLocated());
  EXPECT_LT(error.metres, metres) << steps;
  EXPECT_LT(error.degrees, 1e-5) << steps;
}

TEST(OdometryWatch, AddsUpTheStepsSinceTheLastLocatedScan) {
  Walker walker;
  OdometryWatch watch = watchOf(walker);
  for (int steps = 1; steps < 10; ++steps) {
    EXPECT_TRUE(walker.step(watch));
    expectSince(watch, steps);
  }
  watch.located(kVelocity);
  expectSince(watch, 0);
}

TEST(OdometryWatch, KnowsNothingBeforeAScanIsLocatedWithOdometry) {
  Walker walker;
  OdometryWatch watch(kSpeed, kTurn);
  EXPECT_TRUE(walker.step(watch));
  EXPECT_FALSE(watch.sinceLocated());
  EXPECT_TRUE(walker.without(watch));
  watch.located(kVelocity);
  EXPECT_TRUE(walker.step(watch));
  EXPECT_FALSE(watch.sinceLocated());
  watch.located(kVelocity);
  EXPECT_TRUE(walker.step(watch));
  expectSince(watch, 1);
  watch.forget();
  EXPECT_TRUE(walker.step(watch));
  EXPECT_FALSE(watch.sinceLocated());
}

TEST(OdometryWatch, ALostScanWithoutOdometryIsBridgedByTheNext) {
  Walker walker;
  OdometryWatch watch = watchOf(walker);
  EXPECT_TRUE(walker.without(watch));
  EXPECT_FALSE(watch.sinceLocated());
  EXPECT_TRUE(walker.step(watch));
  expectSince(watch, 2);
}

TEST(OdometryWatch, BridgesAJumpWhereverItComesAmongLostScans) {
  const std::vector<Pose> jumps{translated(30), translated(0, -400e3), translated(0.9), turned(180),
                                turned(-40) * translated(3)};
  for (const Pose& jump : jumps) {
    for (int jump_at = 1; jump_at < 4; ++jump_at) {
      Walker walker;
      OdometryWatch watch = watchOf(walker);
      for (int steps = 1; steps < 6; ++steps) {
        if (steps == jump_at) walker.jumpBy(jump);
        EXPECT_EQ(steps != jump_at, walker.step(watch)) << steps;
        expectSince(watch, steps);
      }
    }
  }
}

TEST(OdometryWatch, SurvivesAbsurdPoses) {
  for (const double absurd : {1e8, 1e80, 1e300, -1e308}) {
    Walker walker;
    OdometryWatch watch = watchOf(walker);
    walker.stamp_ += kPeriod;
    EXPECT_FALSE(watch.add(walker.stamp_, translated(absurd)));
    expectSince(watch, 1);
    walker.T_odom_sensor_ = walker.T_odom_sensor_ * moved(kVelocity, kPeriod);
    EXPECT_FALSE(walker.step(watch));
    expectSince(watch, 2);
    EXPECT_TRUE(walker.step(watch));
    expectSince(watch, 3);
  }
}

TEST(OdometryWatch, APoseThatIsNotFiniteIsLeftOut) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Walker walker;
    OdometryWatch watch = watchOf(walker);
    const Pose before = walker.T_odom_sensor_;
    walker.T_odom_sensor_.translation().y() = bad;
    EXPECT_FALSE(walker.step(watch));
    EXPECT_FALSE(watch.sinceLocated());
    walker.T_odom_sensor_ = before * moved(kVelocity, kPeriod);
    EXPECT_TRUE(walker.step(watch));
    expectSince(watch, 2);
  }
}

TEST(OdometryWatch, LimitsOfSpeedAndTurnGrowWithTime) {
  for (const double seconds : {0.1, 0.5, 2.0}) {
    const auto isPossible = [&](const Pose& step) {
      OdometryWatch watch(3.0, 0.5);
      EXPECT_TRUE(watch.add(10.0, translated(7, 8, 9)));
      return watch.add(10.0 + seconds, translated(7, 8, 9) * step);
    };
    EXPECT_TRUE(isPossible(translated(0, 3.0 * seconds)));
    EXPECT_FALSE(isPossible(translated(0, 3.0 * seconds + 0.6)));
    const double degrees = 0.5 * seconds * 180.0 / M_PI;
    EXPECT_TRUE(isPossible(turned(-degrees)));
    EXPECT_FALSE(isPossible(turned(-degrees - 6.0)));
  }
}

TEST(OdometryWatch, AnOdometryThatStandsStillAtSpeedIsLeftOut) {
  OdometryWatch watch(kSpeed, kTurn);
  Walker walker;
  const Pose step = translated(1.5);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(walker.step(watch, step));
  watch.located(Twist{{15.0, 0.0, 0.0}, {0.0, 0.0, 0.0}});
  for (int i = 1; i < 4; ++i) {
    EXPECT_FALSE(walker.step(watch, Pose::Identity()));
    EXPECT_NEAR(1.5 * i, watch.sinceLocated()->translation().x(), 1e-9);
  }
  EXPECT_TRUE(walker.step(watch, step));
  EXPECT_NEAR(6.0, watch.sinceLocated()->translation().x(), 1e-9);
}

TEST(OdometryWatch, IsBelievedAgainstAMapThatSaysThatTheSensorStands) {
  OdometryWatch watch(kSpeed, kTurn);
  Walker walker;
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(walker.step(watch, translated(2.0)));
    watch.located(i == 0 ? std::nullopt : std::optional<Twist>(Twist{}));
  }
}

TEST(OdometryWatch, ThatGoesOnIsBelievedAgainAfterAStart) {
  OdometryWatch watch(kSpeed, kTurn);
  Walker walker;
  EXPECT_TRUE(walker.step(watch));
  watch.located(Twist{});
  EXPECT_FALSE(walker.step(watch, translated(2.0)));
  EXPECT_TRUE(walker.step(watch, translated(2.0)));
}

TEST(OdometryWatch, IsNotBelievedIfItAloneStandsStill) {
  OdometryWatch watch(kSpeed, kTurn);
  Walker walker;
  for (int i = 0; i < 5; ++i) {
    const double speed = 4.0 * i;  // [m/s]
    EXPECT_EQ(i == 0 || speed * kPeriod < 0.7, walker.step(watch, Pose::Identity())) << speed;
    watch.located(Twist{{speed + 4.0, 0.0, 0.0}, {0.0, 0.0, 0.0}});
  }
}

TEST(OdometryWatch, TheFirstStepMayBeFast) {
  OdometryWatch watch(kSpeed, kTurn);
  Walker walker;
  EXPECT_TRUE(walker.step(watch));
  watch.located(std::nullopt);
  EXPECT_TRUE(walker.step(watch, translated(3.5)));
  EXPECT_DOUBLE_EQ(3.5, watch.sinceLocated()->translation().x());
}

TEST(OdometryWatch, IsExactFarFromTheOrigin) {
  Pose T_odom_start = turned(33);
  T_odom_start.translation() = Eigen::Vector3d(500e3, 5000e3, 500);
  Walker walker(T_odom_start);
  OdometryWatch watch = watchOf(walker);
  for (int steps = 1; steps < 100; ++steps) EXPECT_TRUE(walker.step(watch));
  expectSince(watch, 99, 1e-6);
}

TEST(OdometryWatch, StampsThatRepeatOrGoBackAreNoHarm) {
  Walker walker;
  OdometryWatch watch = watchOf(walker);
  const double stamp = walker.stamp_;
  EXPECT_TRUE(watch.add(stamp, walker.T_odom_sensor_));
  EXPECT_TRUE(watch.add(stamp - kPeriod, walker.T_odom_sensor_));
  EXPECT_TRUE(watch.sinceLocated()->matrix().allFinite());
  EXPECT_TRUE(walker.step(watch));
  EXPECT_NEAR(0.2, watch.sinceLocated()->translation().x(), 0.01);
}

TEST(OdometryWatch, GoesOnFromAnArchiveToTheBit) {
  Walker walker;
  OdometryWatch watch = watchOf(walker);
  walker.step(watch);
  ArchiveWriter writer;
  writer(watch);
  OdometryWatch copy(kSpeed, kTurn);
  ArchiveReader reader(writer.bytes());
  reader(copy);
  reader.requireEnd();
  walker.jumpBy(translated(50));
  EXPECT_FALSE(walker.step(watch));
  EXPECT_FALSE(copy.add(walker.stamp_, walker.T_odom_sensor_));
  EXPECT_TRUE(sameBits(*watch.sinceLocated(), *copy.sinceLocated()));
}

}  // namespace
}  // namespace edgevox::test
