// SPDX-License-Identifier: BSD-3-Clause
// What the mapper makes of good, bad, late and missing scans.
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "edgevox/mapping/mapper.hpp"
#include "edgevox/statistics.hpp"
#include "support/sweeps.hpp"
#include "support/voxel_sets.hpp"

namespace edgevox::test {
namespace {

VoxelScan randomScan(double stamp) {
  VoxelScan scan = voxelScans({randomSweep(7, stamp, 20000)}, Config{})[0];
  scan.number = 1000;
  return scan;
}

/// A mapper that has seen the first `count` scans.
Mapper mapperAfter(size_t count) {
  Mapper mapper{Config{}};
  for (size_t i = 0; i < count; ++i) EXPECT_TRUE(mapper.process(buildingScans()[i]).located()) << i;
  return mapper;
}

/// What must not change.
struct MapState {
  explicit MapState(const Mapper& mapper)
      : scans(mapper.map().scans()),
        hit(voxelsOf(mapper.map().hitVoxels())),
        edges(voxelsOf(mapper.map().edgeVoxels())),
        selected(mapper.map().matchMap().surfaces().selectedCount()),
        cells(mapper.map().moments().size()) {
    for (int level = 1; level < mapper.map().levels(); ++level) {
      occupied.push_back(voxelsOf(mapper.map().matchMap().occupied(level)));
    }
  }

  bool operator==(const MapState& o) const {
    return scans == o.scans && hit == o.hit && edges == o.edges && occupied == o.occupied &&
           selected == o.selected && cells == o.cells;
  }

  uint32_t scans;
  Voxels hit;
  Voxels edges;
  std::vector<Voxels> occupied;
  size_t selected;
  size_t cells;
};

std::vector<ScanResult> processAll(Mapper& mapper, size_t count) {
  std::vector<ScanResult> results;
  for (size_t i = 0; i < count; ++i) results.push_back(mapper.process(buildingScans()[i]));
  return results;
}

TEST(Status, OfTheFirstScansIsFirstThenFallbackThenTracked) {
  Mapper mapper{Config{}};
  const auto results = processAll(mapper, 12);
  EXPECT_EQ(ScanStatus::kFirst, results[0].status);
  EXPECT_TRUE(sameBits(Pose::Identity(), results[0].T_map_sensor));
  EXPECT_EQ(ScanStatus::kFallback, results[1].status);  // no voxel has two hits yet
  for (size_t i = 8; i < results.size(); ++i) {
    EXPECT_EQ(ScanStatus::kTracked, results[i].status) << i << toString(results[i].status);
  }
  EXPECT_EQ(12U, mapper.map().scans());
  for (size_t i = 0; i < results.size(); ++i) {
    EXPECT_EQ(buildingScans()[i].stamp, results[i].stamp);
    EXPECT_EQ(buildingScans()[i].number, results[i].number);
  }
}

TEST(Status, OfALateOrRepeatedScanIsStale) {
  Mapper mapper = mapperAfter(5);
  const MapState before(mapper);
  for (const size_t late : {4U, 2U}) {
    const ScanResult result = mapper.process(buildingScans()[late]);
    EXPECT_EQ(ScanStatus::kStale, result.status);
    EXPECT_FALSE(result.located());
  }
  VoxelScan no_time = buildingScans()[5];
  no_time.stamp = std::nan("");
  EXPECT_EQ(ScanStatus::kStale, mapper.process(no_time).status);
  EXPECT_TRUE(before == MapState(mapper));
  Mapper other = mapperAfter(5);
  EXPECT_TRUE(sameBits(other.process(buildingScans()[5]).T_map_sensor,
                       mapper.process(buildingScans()[5]).T_map_sensor));
}

TEST(Status, OfAScanOfAFewVoxelsIsTooFew) {
  for (const size_t before : {0U, 5U}) {
    Mapper mapper = mapperAfter(before);
    const MapState state(mapper);
    VoxelScan few = buildingScans()[before];
    few.voxels.resize(49);
    few.stamp -= 0.01;
    EXPECT_EQ(ScanStatus::kTooFew, mapper.process(few).status);
    few.voxels.clear();
    few.stamp += 0.001;
    EXPECT_EQ(ScanStatus::kTooFew, mapper.process(few).status);
    EXPECT_TRUE(state == MapState(mapper));
    Mapper other = mapperAfter(before);
    EXPECT_TRUE(sameBits(other.process(buildingScans()[before]).T_map_sensor,
                         mapper.process(buildingScans()[before]).T_map_sensor));
  }
}

TEST(Status, OfAScanOfMoreVoxelsThanAllowedIsTooLarge) {
  Config config;
  config.voxelizer.max_voxels = static_cast<int>(buildingScans()[3].voxels.size());
  Mapper mapper{config};
  VoxelScan large = buildingScans()[2];
  while (large.voxels.size() <= buildingScans()[3].voxels.size())
    large.voxels.push_back(large.voxels[7]);
  EXPECT_EQ(ScanStatus::kTooLarge, mapper.process(large).status);
  EXPECT_TRUE(mapper.map().empty());
  VoxelScan given_up = buildingScans()[2];
  given_up.too_large = "it has too many points";
  EXPECT_EQ(ScanStatus::kTooLarge, mapper.process(given_up).status);
  EXPECT_EQ(ScanStatus::kFirst, mapper.process(buildingScans()[3]).status);
}

TEST(Lost, ABadScanChangesNothingAndTheNextIsTracked) {
  Mapper mapper = mapperAfter(20);
  const MapState before(mapper);
  Mapper other = mapperAfter(19);
  const Pose last = other.process(buildingScans()[19]).T_map_sensor;

  const ScanResult lost = mapper.process(randomScan(buildingScans()[20].stamp));
  EXPECT_EQ(ScanStatus::kLost, lost.status);
  EXPECT_FALSE(lost.located());
  EXPECT_LT(lost.hit_ratio, lost.required_hit_ratio);
  EXPECT_TRUE(sameBits(last, lost.T_map_sensor));
  EXPECT_TRUE(before == MapState(mapper));

  for (size_t i = 21; i < 26; ++i) {
    const ScanResult result = mapper.process(buildingScans()[i]);
    EXPECT_TRUE(result.located()) << i;
    const PoseDifference error = differenceOf(buildingWalk().truth[i].pose, result.T_map_sensor);
    EXPECT_LT(error.metres, 0.05);
  }
}

TEST(Lost, SeveralBadScansInARowAreSurvived) {
  Mapper mapper = mapperAfter(20);
  for (size_t i = 20; i < 24; ++i) {
    EXPECT_EQ(ScanStatus::kLost, mapper.process(randomScan(buildingScans()[i].stamp)).status);
  }
  const ScanResult result = mapper.process(buildingScans()[24]);
  EXPECT_TRUE(result.located());
  EXPECT_LT(differenceOf(buildingWalk().truth[24].pose, result.T_map_sensor).metres, 0.05);
}

/// Sweep i by a sensor that has turned by `T_still_turned`.
VoxelScan turnedScan(size_t i, const Pose& T_still_turned) {
  Sweep sweep = buildingWalk().sweeps[i];
  for (auto& [x, y, z, time] : sweep.points) {
    const Eigen::Vector3f p = (T_still_turned.inverse() * Eigen::Vector3d(x, y, z)).cast<float>();
    x = p.x();
    y = p.y();
    z = p.z();
  }
  return voxelScans({sweep}, Config{})[0];
}

/// What becomes, without restarts, of a scan a second after four of a standing sensor, which
/// has turned.
ScanResult afterATurn(const Pose& T_still_turned, bool with_odometry) {
  // Any smooth frame: turned and far from the map.
  Pose T_odom_map(Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ()));
  T_odom_map.translation() = Eigen::Vector3d(30, -20, 1);
  Config config;
  config.matcher.max_restarts = 0;
  Mapper mapper{config};
  ScanResult result;
  for (const bool turned : {false, false, false, false, true}) {
    const Pose T_map_sensor = turned ? T_still_turned : Pose::Identity();
    VoxelScan scan = turnedScan(0, T_map_sensor);
    scan.stamp = result.stamp + (turned ? 1.0 : 0.1);
    for (ScanVoxel& voxel : scan.voxels) voxel.time_offset = 0.0F;
    ScanPrior prior;
    if (with_odometry) prior.T_odom_sensor = T_odom_map * T_map_sensor;
    result = mapper.process(scan, prior);
  }
  return result;
}

TEST(Odometry, BridgesWhatAConstantVelocityCannot) {
  for (const double angle : {3.0, -2.8, -3.1}) {  // [rad]
    const Pose truth(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
    const ScanResult with = afterATurn(truth, true);
    EXPECT_TRUE(with.located()) << angle;
    EXPECT_LT(differenceOf(truth, with.T_map_sensor).metres, 0.06) << angle;
    const ScanResult without = afterATurn(truth, false);
    EXPECT_GT(differenceOf(truth, without.T_map_sensor).degrees, 5.0) << angle;
  }
}

TEST(Odometry, OfUtmCoordinatesStartsTheMapAtTheSensor) {
  Pose T_odom_map(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
  T_odom_map.translation() = Eigen::Vector3d(691000, 5335000, 515);
  Mapper mapper{Config{}};
  const Pose T_map_first(T_odom_map.rotation());
  for (size_t i = 0; i < 10; ++i) {
    const Pose T_odom_sensor = T_odom_map * buildingWalk().truth[i].pose;
    const ScanResult result = mapper.process(buildingScans()[i], {T_odom_sensor, T_odom_sensor});
    ASSERT_TRUE(result.located());
    EXPECT_LT(differenceOf(T_map_first * buildingWalk().truth[i].pose, result.T_map_sensor).metres,
              0.03);
  }
  EXPECT_GT(mapper.map().hitVoxels().voxelCount(), 1000U);
}

/// Scan i, `seconds` later.
VoxelScan shifted(size_t i, double seconds) {
  VoxelScan scan = buildingScans()[i];
  scan.stamp += seconds;
  return scan;
}

TEST(Clock, OneScanFromLongAgoIsStaleAndChangesNothing) {
  Mapper mapper = mapperAfter(20);
  const MapState before(mapper);
  EXPECT_EQ(ScanStatus::kStale, mapper.process(shifted(20, -100)).status);
  EXPECT_TRUE(before == MapState(mapper));
  Mapper other = mapperAfter(20);
  EXPECT_TRUE(sameBits(other.process(buildingScans()[20]).T_map_sensor,
                       mapper.process(buildingScans()[20]).T_map_sensor));
  // Nor do several of them that do not follow one another.
  for (const double seconds : {-50.0, -50.0, -60.0}) {
    EXPECT_EQ(ScanStatus::kStale, mapper.process(shifted(21, seconds)).status);
  }
}

TEST(Clock, AfterAJumpBackTheMapIsKept) {
  Mapper mapper = mapperAfter(20);
  const uint32_t scans_before = mapper.map().scans();
  EXPECT_EQ(ScanStatus::kStale, mapper.process(shifted(20, -100)).status);
  for (size_t i = 21; i < 26; ++i) {
    const ScanResult result = mapper.process(shifted(i, -100));
    EXPECT_TRUE(result.located()) << i;
    EXPECT_EQ(i == 21, result.clock_jumped);
    EXPECT_LT(differenceOf(buildingWalk().truth[i].pose, result.T_map_sensor).metres, 0.05);
  }
  EXPECT_EQ(scans_before + 5, mapper.map().scans());
}

TEST(Clock, AfterAJumpBackTheMapIsClearedIfConfigured) {
  Config config;
  config.mapper.after_clock_jump = AfterClockJump::kClearMap;
  Mapper mapper{config};
  processAll(mapper, 20);
  EXPECT_EQ(ScanStatus::kStale, mapper.process(shifted(0, -100)).status);
  EXPECT_EQ(20U, mapper.map().scans());
  const ScanResult first = mapper.process(shifted(1, -100));
  EXPECT_EQ(ScanStatus::kFirst, first.status);
  EXPECT_TRUE(first.clock_jumped);
  EXPECT_EQ(1U, mapper.map().scans());
}

TEST(Clock, AScanFromTheFutureDoesNotStopTheMapping) {
  Mapper mapper = mapperAfter(20);
  mapper.process(shifted(20, 1000));
  EXPECT_EQ(ScanStatus::kStale, mapper.process(buildingScans()[21]).status);
  for (size_t i = 22; i < 25; ++i) {
    const ScanResult result = mapper.process(buildingScans()[i]);
    EXPECT_TRUE(result.located()) << i;
    EXPECT_LT(differenceOf(buildingWalk().truth[i].pose, result.T_map_sensor).metres, 0.05);
  }
}

TEST(Clock, ALostScanWithAWrongStampDoesNotMakeTheNextOnesLate) {
  Mapper mapper = mapperAfter(20);
  EXPECT_EQ(ScanStatus::kLost, mapper.process(randomScan(1e3)).status);
  EXPECT_TRUE(mapper.process(buildingScans()[20]).located());
}

constexpr double kDay = 86400.0;  // [s]

/// Later than all before it by more than is likely.
void expectAhead(const ScanResult& result) {
  EXPECT_EQ(ScanStatus::kStale, result.status);
  EXPECT_TRUE(result.ahead);
}

TEST(Clock, ScansFromFarAheadChangeNothingUnlessTheyFollowOneAnother) {
  Mapper mapper = mapperAfter(20);
  Mapper other = mapperAfter(20);
  const MapState before(mapper);
  for (const double seconds : {kDay, kDay, 0.5 * kDay, 2e9}) {
    expectAhead(mapper.process(shifted(20, seconds)));
  }
  EXPECT_TRUE(before == MapState(mapper));
  for (size_t i = 20; i < 24; ++i) {
    const ScanResult result = mapper.process(buildingScans()[i]);
    EXPECT_TRUE(result.located() && !result.ahead);
    EXPECT_TRUE(sameBits(other.process(buildingScans()[i]).T_map_sensor, result.T_map_sensor));
    expectAhead(mapper.process(shifted(i, kDay)));  // the good one between them speaks against it
  }
}

TEST(Clock, AfterAPauseTheSecondScanIsUsed) {
  Mapper mapper = mapperAfter(20);
  expectAhead(mapper.process(shifted(20, kDay)));
  for (size_t i = 21; i < 24; ++i) {
    const ScanResult result = mapper.process(shifted(i, kDay));
    EXPECT_TRUE(result.located()) << i;
    EXPECT_LT(differenceOf(buildingWalk().truth[i].pose, result.T_map_sensor).metres, 0.05);
  }
}

TEST(Clock, ScansLostForLongerThanALeapAreNotAhead) {
  Config config;
  config.mapper.clock_leap = 1.0;
  Mapper mapper{config};
  processAll(mapper, 5);
  for (int i = 1; i < 8; ++i) {
    EXPECT_EQ(ScanStatus::kLost,
              mapper.process(randomScan(buildingScans()[4].stamp + 0.5 * i)).status);
  }
}

TEST(Clock, SweepsAtTheSameTimeAreStale) {
  VoxelScan too_soon = shifted(20, buildingScans()[19].stamp - buildingScans()[20].stamp + 1e-5);
  VoxelScan at_once = too_soon;  // its middle is that of the scan before
  for (ScanVoxel& voxel : at_once.voxels) voxel.time_offset -= 1e-5F;
  VoxelScan before_it = too_soon;
  for (ScanVoxel& voxel : before_it.voxels) voxel.time_offset -= 0.2F;
  for (const VoxelScan& scan : {too_soon, at_once, before_it}) {
    Mapper mapper = mapperAfter(20);
    Mapper other = mapperAfter(20);
    EXPECT_EQ(ScanStatus::kStale, mapper.process(scan).status);
    EXPECT_TRUE(sameBits(other.process(buildingScans()[20]).T_map_sensor,
                         mapper.process(buildingScans()[20]).T_map_sensor));
  }
}

TEST(MapFrame, IsWhereTheFirstScanIsPut) {
  Pose T_map_first(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()));
  T_map_first.translation() = Eigen::Vector3d(3, -4, 1.4);
  Mapper mapper{Config{}};
  ScanPrior prior;
  prior.T_map_first = T_map_first;
  EXPECT_TRUE(sameBits(T_map_first, mapper.process(buildingScans()[0], prior).T_map_sensor));
  prior.T_map_first = Pose::Identity();  // has no meaning any more
  for (size_t i = 1; i < 10; ++i) {
    const ScanResult result = mapper.process(buildingScans()[i], prior);
    ASSERT_TRUE(result.located());
    EXPECT_LT(differenceOf(T_map_first * buildingWalk().truth[i].pose, result.T_map_sensor).metres,
              0.03);
  }
}

TEST(Trajectory, DoesNotDependOnTheScansNumbers) {
  Mapper mapper = mapperAfter(20);
  Mapper other = mapperAfter(20);
  for (const size_t i : {24U, 25U}) {
    VoxelScan scan = buildingScans()[i];
    scan.number += 1000;
    EXPECT_TRUE(sameBits(other.process(buildingScans()[i]).T_map_sensor,
                         mapper.process(scan).T_map_sensor));
  }
}

TEST(Reset, GivesTheSameTrajectoryAgain) {
  Mapper mapper{Config{}};
  const auto first = processAll(mapper, 25);
  mapper.process(randomScan(1e6));
  mapper.reset();
  EXPECT_TRUE(mapper.map().empty());
  const auto again = processAll(mapper, 25);
  for (size_t i = 0; i < first.size(); ++i) {
    ASSERT_EQ(first[i].status, again[i].status);
    ASSERT_TRUE(sameBits(first[i].T_map_sensor, again[i].T_map_sensor)) << i;
    ASSERT_EQ(first[i].hit_ratio, again[i].hit_ratio);
  }
}

constexpr double kTurnRate = M_PI / 3;  // [rad/s]

Pose turning(double time) {
  Pose pose(Eigen::AngleAxisd(kTurnRate * time, Eigen::Vector3d::UnitZ()));
  pose.translation() = Eigen::Vector3d(0.4 * std::cos(time), 0.3 * std::sin(time), 0);
  return pose;
}

struct Turn {
  double median_deg;  ///< of the steps from pose to pose
  double p95_m;
  size_t voxels;  ///< of the map, hit in two scans
  size_t lost;
};

/// Two thirds of a turn in a room.
Turn mapTurn(bool with_times) {
  const sim::World room = furnishedRoom();
  sim::Sensor sensor = sim::makeSensor("32");
  sensor.columns = 512;
  Config config;
  config.voxel_size = 0.1;
  config.map.coarsest_voxel = 3.2;
  std::vector<Sweep> sweeps;
  for (int i = 0; i < 40; ++i) {
    const double stamp = 0.1 * i;
    sweeps.push_back(castSweep(
        room, sensor, [&](double t) { return turning(stamp + t); }, stamp,
        static_cast<uint32_t>(i)));
  }
  Mapper mapper(config);
  Turn turn{0, 0, 0, 0};
  std::vector<double> degrees;
  std::vector<double> metres;
  Pose last = Pose::Identity();
  for (VoxelScan& scan : voxelScans(sweeps, config)) {
    // Without times the scan counts as taken at once, in the middle of the sweep.
    const double middle = with_times ? 0.0 : 0.05;
    for (ScanVoxel& v : scan.voxels) v.time_offset = with_times ? v.time_offset : 0.0F;
    const ScanResult result = mapper.process(scan);
    turn.lost += result.located() ? 0 : 1;
    const double now = scan.stamp + middle;
    const Pose step = turning(now - 0.1).inverse() * turning(now);
    const PoseDifference error = differenceOf(step, last.inverse() * result.T_map_sensor);
    if (scan.stamp > 0.95) {
      degrees.push_back(error.degrees);
      metres.push_back(error.metres);
    }
    last = result.T_map_sensor;
  }
  turn.median_deg = quantile(degrees, 0.5);
  turn.p95_m = quantile(metres, 0.95);
  turn.voxels = mapper.map().hitVoxels().voxelCount();
  return turn;
}

TEST(Deskew, SharpensTheMapOfATurningSensor) {
  const Turn with = mapTurn(true);
  const Turn without = mapTurn(false);
  RecordProperty("voxels_with_times", static_cast<int>(with.voxels));
  RecordProperty("voxels_without", static_cast<int>(without.voxels));
  RecordProperty("median_deg_with_times", std::to_string(with.median_deg));
  RecordProperty("median_deg_without", std::to_string(without.median_deg));
  EXPECT_EQ(0U, with.lost);
  EXPECT_LT(with.median_deg, 0.1);
  EXPECT_LT(static_cast<double>(with.voxels), 0.9 * static_cast<double>(without.voxels));
}

}  // namespace
}  // namespace edgevox::test
