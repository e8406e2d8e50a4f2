// SPDX-License-Identifier: BSD-3-Clause
// What the mapper makes of an odometry that jumps, stands still or is not finite.
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "edgevox/archive.hpp"
#include "edgevox/mapping/mapper.hpp"
#include "support/sweeps.hpp"

namespace edgevox::test {
namespace {

constexpr size_t kCount = 36;
constexpr size_t kJump = 16;  // the first scan after it

using Odometry = std::function<Pose(size_t scan)>;

/// True up to kJump, and put `jump` off from then on.
Odometry jumping(const Pose& jump) {
  return [=](size_t i) {
    return i < kJump ? buildingWalk().truth[i].pose : jump * buildingWalk().truth[i].pose;
  };
}

Pose translated(double x, double y, double z) { return Pose(Eigen::Translation3d(x, y, z)); }

VoxelScan noise(size_t i) {
  return voxelScans({randomSweep(static_cast<uint32_t>(i), buildingScans()[i].stamp, 20000)},
                    Config{})[0];
}

void expectTrue(size_t i, const ScanResult& result, const Pose& T_map_first = Pose::Identity()) {
  EXPECT_TRUE(result.located()) << i;
  const Pose expected = T_map_first * buildingWalk().truth[i].pose;
  EXPECT_LT(differenceOf(expected, result.T_map_sensor).metres, 0.05) << i;
}

/// All scans are located where they were taken, the scans `jumps` without their odometry.
void expectBridged(const Odometry& odometry, const std::vector<size_t>& jumps) {
  Mapper mapper{Config{}};
  for (size_t i = 0; i < kCount; ++i) {
    ScanPrior prior;
    prior.T_odom_sensor = odometry(i);
    const ScanResult result = mapper.process(buildingScans()[i], prior);
    expectTrue(i, result);
    const bool jumped = std::find(jumps.begin(), jumps.end(), i) != jumps.end();
    EXPECT_EQ(jumped, result.odometry_jumped) << i;
  }
}

TEST(OdometryJumps, AreBridged) {
  expectBridged(jumping(translated(30, 0, 0)), {kJump});
  expectBridged(jumping(translated(-400e3, 5e3, 0)), {kJump});
  expectBridged(jumping(translated(0.6, 1.1, 0)), {kJump});
  expectBridged(jumping(Pose(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()))), {kJump});
}

TEST(OdometryJumps, ThatAreSmallAreCorrectedByTheMatch) {
  expectBridged(jumping(translated(0.5, 0, 0)), {});
  expectBridged(jumping(Pose(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()))), {});
}

TEST(OdometryJumps, OfOneScanAreTwo) {
  for (const double absurd : {1e6, 1e8, 1e12, 1e80, 1e300}) {
    expectBridged(
        [=](size_t i) {
          return i == kJump ? translated(absurd, 0, 0) : buildingWalk().truth[i].pose;
        },
        {kJump, kJump + 1});
  }
}

TEST(OdometryJumps, APoseThatIsNotFiniteIsNotUsed) {
  const Pose bad = translated(std::nan(""), 0, 0);
  expectBridged([=](size_t i) { return i == kJump ? bad : buildingWalk().truth[i].pose; }, {kJump});
}

TEST(OdometryJumps, InEveryScanLeaveTheConstantVelocity) {
  std::vector<size_t> all_but_the_first;
  for (size_t i = 1; i < kCount; ++i) all_but_the_first.push_back(i);
  expectBridged([](size_t i) { return translated(50.0 * static_cast<double>(i * i), 0, 0); },
                all_but_the_first);
}

TEST(OdometryJumps, AnOdometryThatStandsStillIsCorrectedByTheMatch) {
  expectBridged([](size_t i) { return buildingWalk().truth[std::min(i, kJump)].pose; }, {});
}

TEST(OdometryJumps, AreBridgedAmongLostScans) {
  const Odometry odometry = jumping(translated(30, -400, 2));
  constexpr size_t kLost = 14;  // the first
  constexpr size_t kFound = 30;
  ASSERT_GT((buildingWalk().truth[kFound].pose.translation() -
             buildingWalk().truth[kLost].pose.translation())
                .norm(),
            1.2);
  Mapper mapper{Config{}};
  for (size_t i = 0; i < kCount; ++i) {
    ScanPrior prior;
    prior.T_odom_sensor = odometry(i);
    const bool lost = i >= kLost && i < kFound;
    const ScanResult result = mapper.process(lost ? noise(i) : buildingScans()[i], prior);
    EXPECT_EQ(i == kJump, result.odometry_jumped) << i;
    if (lost) EXPECT_EQ(ScanStatus::kLost, result.status) << i;
    if (!lost) expectTrue(i, result);
    if (i == kFound) EXPECT_EQ(0, result.restarts) << "dead reckoning has led it there";
  }
}

TEST(OdometryJumps, AreSeenBehindScansOfAFewVoxels) {
  const Odometry odometry = jumping(translated(3.5, 0, 0));
  Mapper mapper{Config{}};
  for (size_t i = 0; i < kCount; ++i) {
    ScanPrior prior;
    prior.T_odom_sensor = odometry(i);
    VoxelScan scan = buildingScans()[i];
    const bool few = i + 4 >= kJump && i <= kJump;
    if (few) scan.voxels.resize(10);
    const ScanResult result = mapper.process(scan, prior);
    EXPECT_EQ(i == kJump, result.odometry_jumped) << i;
    if (few) EXPECT_EQ(ScanStatus::kTooFew, result.status);
    if (!few) expectTrue(i, result);
  }
}

TEST(OdometryJumps, GoOnFromAnArchiveToTheBit) {
  const Odometry odometry = jumping(translated(30, 0, 0));
  Mapper mapper{Config{}};
  Mapper copy{Config{}};
  for (size_t i = 0; i < kCount; ++i) {
    if (i == kJump) {
      ArchiveWriter writer;
      writer(mapper);
      ArchiveReader reader(writer.bytes());
      reader(copy);
    }
    ScanPrior prior;
    prior.T_odom_sensor = odometry(i);
    const ScanResult result = mapper.process(buildingScans()[i], prior);
    if (i < kJump) continue;
    EXPECT_TRUE(sameBits(result.T_map_sensor, copy.process(buildingScans()[i], prior).T_map_sensor))
        << i;
  }
}

TEST(OdometryJumps, UtmCoordinatesGiveTheSamePoses) {
  Pose T_utm_odom(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
  Mapper near{Config{}};
  Mapper far{Config{}};
  for (size_t i = 0; i < kCount; ++i) {
    ScanPrior prior;
    T_utm_odom.translation().setZero();
    prior.T_odom_sensor = prior.T_map_first = T_utm_odom * buildingWalk().truth[i].pose;
    const ScanResult expected = near.process(buildingScans()[i], prior);
    T_utm_odom.translation() = Eigen::Vector3d(500e3, 5000e3, 500);
    prior.T_odom_sensor = prior.T_map_first = T_utm_odom * buildingWalk().truth[i].pose;
    const ScanResult result = far.process(buildingScans()[i], prior);
    ASSERT_TRUE(expected.located() && result.located() && !result.odometry_jumped);
    EXPECT_LT(differenceOf(expected.T_map_sensor, result.T_map_sensor).metres, 1e-4) << i;
    const Pose T_map_odom = result.T_map_sensor * prior.T_odom_sensor->inverse();
    EXPECT_LT(differenceOf(result.T_map_sensor, T_map_odom * *prior.T_odom_sensor).metres, 1e-6);
  }
}

}  // namespace
}  // namespace edgevox::test
