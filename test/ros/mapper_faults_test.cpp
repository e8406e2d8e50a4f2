// SPDX-License-Identifier: BSD-3-Clause
// edgevox/Mapper: bad scans between good ones, wrong clocks, drops.
#include <nav_msgs/Path.h>

#include <limits>
#include <map>
#include <string>
#include <vector>

#include "edgevox/tracking/scan_result.hpp"
#include "ros/conversions/voxel_scan_message.hpp"
#include "ros/mapper_fixture.hpp"
#include "support/sweeps.hpp"

namespace edgevox::test {
namespace {

using Log = rosgraph_msgs::Log;

/// The walk with bad scans: one before each of these.
Scans walkWith(const std::map<size_t, VoxelScanStamped>& bad) {
  Scans all;
  for (size_t i = 0; i < scans().size(); ++i) {
    if (bad.count(i) > 0) all.push_back(bad.at(i));
    all.push_back(scans()[i]);
  }
  return all;
}

class FaultsTest : public MapperTest {
 protected:
  /// Sends the walk with the bad scans in it; they must have the status, the others the poses that
  /// they have without them.
  void expectWithout(const std::map<size_t, VoxelScanStamped>& bad, const std::string& status,
                     const std::vector<std::string>& words) {
    start();
    map(walkWith(bad));
    expectOdometry(walkPoses());
    size_t found = 0;
    for (const auto& report : reports_.messages()) {
      if (report->located) continue;
      ++found;
      EXPECT_EQ(status, report->status);
      EXPECT_TRUE(hasWords(report->text, words)) << report->text;
    }
    EXPECT_EQ(bad.size(), found);
    EXPECT_TRUE(logs(Log::WARN, {resolved("mapper"), " is " + status}));
  }

  /// The trajectory, the reports and the warning after the clock has jumped back.
  void expectJump(const Config& config, const std::string& words) {
    Scans sent = firstScans(kMiddle);
    for (size_t i = 0; i < scans().size(); ++i) sent.push_back(shifted(i, -100.0));
    map(sent);
    const auto results = mapped(sent, {}, config);
    ASSERT_TRUE(results[kMiddle + 1].clock_jumped && results.back().located());
    expectOdometry(posesOf(results));
    for (size_t i = 0; i < sent.size(); ++i)
      EXPECT_EQ(toString(results[i].status), statusOf(i)) << i;
    EXPECT_EQ("stale", statusOf(kMiddle));
    EXPECT_TRUE(logs(Log::WARN, {resolved("mapper"), "stamps have jumped back", words}));
  }
};

TEST_F(FaultsTest, LateAndRepeatedScansAreStale) {
  VoxelScanStamped years_ago = scans()[10];
  years_ago.header.stamp = ros::Time(1000, 0);
  expectWithout({{5, scans()[4]}, {7, scans()[2]}, {10, years_ago}}, "stale",
                {"not later than", "driver's stamps"});
}

TEST_F(FaultsTest, ScansFromFarAheadAreStale) {
  expectWithout({{4, shifted(3, 86400)}, {8, shifted(7, 86401)}, {12, shifted(11, 1e9)}}, "stale",
                {"mapper/clock_leap", "driver's clock"});
}

TEST_F(FaultsTest, BadStampsAreRefusedAndCounted) {
  VoxelScanStamped not_set = scans()[5];
  not_set.header.stamp = ros::Time();
  VoxelScanStamped last = scans()[7];
  last.header.stamp.sec = std::numeric_limits<uint32_t>::max();
  VoxelScanStamped near_the_end = scans()[10];
  near_the_end.header.stamp.sec = std::numeric_limits<uint32_t>::max() - 28;
  VoxelScanStamped nanoseconds = scans()[12];
  nanoseconds.header.stamp.nsec = 1000000000;
  expectWithout({{0, last}, {5, not_set}, {8, last}, {11, near_the_end}, {13, nanoseconds}},
                "bad_stamp", {"its stamp is", "correct the clock"});
  for (const auto& report : reports_.messages()) {
    EXPECT_EQ(report->status == "bad_stamp", report->header.stamp.isZero());
  }
  EXPECT_TRUE(
      tells("mapper", [](const Status& s) { return valueOf(s, "scans bad_stamp") == "5"; }));
}

TEST_F(FaultsTest, ScansOfAFewVoxelsAreTooFew) {
  VoxelScanStamped few = shifted(3, 0.05);
  few.voxels.resize(49);
  VoxelScanStamped none = shifted(8, 0.05);
  none.voxels.clear();
  VoxelScanStamped impossible = shifted(9, 0.05);
  for (Voxel& v : impossible.voxels) v.centroid.z = std::numeric_limits<float>::quiet_NaN();
  expectWithout({{4, few}, {9, none}, {10, impossible}}, "too_few", {"too few voxels", "covered"});
}

TEST_F(FaultsTest, ImpossibleVoxelsAreLeftOut) {
  Scans sent = scans();
  for (VoxelScanStamped& scan : sent) {
    const auto middle = scan.voxels.begin() + static_cast<std::ptrdiff_t>(scan.voxels.size() / 2);
    Voxel bad = *middle;
    bad.centroid.x = std::numeric_limits<float>::infinity();
    scan.voxels.insert(middle, bad);
    bad = scan.voxels.front();
    bad.time_offset = -1e6F;
    scan.voxels.push_back(bad);
    bad = scan.voxels.front();
    bad.x = std::numeric_limits<int32_t>::max();
    scan.voxels.insert(scan.voxels.begin(), bad);
  }
  start();
  map(sent);
  expectOdometry(walkPoses());
}

TEST_F(FaultsTest, ScansOfAnotherConfigurationAreRefused) {
  Config ratio;
  ratio.edges.scan.ratio = 0.25;
  VoxelScanStamped other_edges = shifted(4, 0.05);
  other_edges.settings.clear();
  addSettings(ratio, {"voxel_size", "voxelizer/", "edges/"}, other_edges);
  VoxelScanStamped again = other_edges;
  again.header.stamp = stampAfter(11, 0.05);
  expectWithout({{0, other_edges}, {5, other_edges}, {12, again}}, "config_mismatch",
                {"'edges/scan_ratio' is 0.25", "here it is 0.1", "the same configuration"});
  VoxelScanStamped coarse = shifted(kScans - 1, 0.1);
  coarse.settings.clear();
  coarse.voxel_size = 0.2;
  map({coarse});
  EXPECT_TRUE(tells("mapper", Status::ERROR,
                    {"config_mismatch for 1 scans", "'voxel_size' is 0.4", "here it is 0.2"}));
}

TEST_F(FaultsTest, ALostScanIsAnErrorAndTheNextOnesAreTracked) {
  publishStatic({transformOf("base_link", "lidar", ros::Time(0), Pose::Identity())});
  setParameter("mapper", "base_frame", "base_link");
  setParameter("mapper", "transform_wait", 5.0);
  start();
  Scans sent = firstScans(kMiddle);
  for (const int i : {1, 2, 3}) {
    sent.push_back(randomScan(stampAfter(kMiddle - 1, 0.05 + 0.01 * i), static_cast<uint32_t>(i)));
  }
  map(sent);
  EXPECT_TRUE(tells("mapper", Status::ERROR,
                    {"LOST for 3 scans", "of the scan fits the map", "call reset"}));
  EXPECT_EQ(kMiddle, transformsTo("base_link").size());  // none of the lost ones
  const Scans rest(scans().begin() + kMiddle, scans().end());
  map(rest);
  sent.insert(sent.end(), rest.begin(), rest.end());
  const auto results = mapped(sent);
  expectOdometry(posesOf(results));
  for (size_t i = 0; i < sent.size(); ++i) {
    EXPECT_EQ(i >= kMiddle && i < kMiddle + 3, statusOf(i) == "lost") << i;
  }
  EXPECT_LT(differenceOf(walkPoses().back(), posesOf(results).back()).metres, 0.02);
  EXPECT_TRUE(tells("mapper", Status::OK, {"tracked"}));
}

TEST_F(FaultsTest, OneLostScanDoesNotChangeThePosesAfterIt) {
  const std::map<size_t, VoxelScanStamped> bad = {{kMiddle, randomScan(stampAfter(7, 0.08))}};
  expectWithout(bad, "lost", {"fits the map", "go back to a mapped place"});
}

TEST_F(FaultsTest, AMapOfNoiseIsBegunAnew) {
  setParameter("mapper", "map_period", 0.1);
  const ros::Time begin = stampAfter(0, -0.1);
  const Sweep noise = randomSweep(3, begin.toSec(), 4000);
  Scans sent{edgesOf(voxelScans({noise}, Config{}).front(), begin)};
  sent.insert(sent.end(), scans().begin(), scans().end());
  start();
  map(sent);
  const auto results = mapped(sent);
  expectOdometry(posesOf(results));
  const auto reports = reports_.messages();
  for (size_t i = 0; i < reports.size(); ++i) {
    EXPECT_EQ(i != 1, reports[i]->located != 0) << i;
    EXPECT_EQ(i == 2, reports[i]->begun_anew != 0) << i;
  }
  EXPECT_TRUE(logs(Log::WARN, {resolved("mapper"), "the map is begun anew", "covered"}));
  EXPECT_TRUE(
      tells("mapper", [](const Status& s) { return valueOf(s, "maps begun anew") == "1"; }));
  const Listener<nav_msgs::Path> path(resolved("path"));
  ASSERT_TRUE(path.waitFor(1));
  EXPECT_EQ(scans()[1].header.stamp, path.messages()[0]->poses.front().header.stamp);
}

TEST_F(FaultsTest, AfterAJumpBackTheMapIsKept) {
  start();
  expectJump(Config{}, "kept; call reset");
  EXPECT_EQ("first", statusOf(0));
  EXPECT_NE("first", statusOf(kMiddle + 1));
}

TEST_F(FaultsTest, AfterAJumpBackTheMapIsClearedIfToldSo) {
  setParameter("mapper", "mapper/after_clock_jump", "clear_map");
  setParameter("mapper", "map_period", 0.1);
  Config config;
  config.mapper.after_clock_jump = AfterClockJump::kClearMap;
  start();
  expectJump(config, "cleared");
  EXPECT_EQ("first", statusOf(kMiddle + 1));
  const Listener<nav_msgs::Path> path(resolved("path"));
  ASSERT_TRUE(path.waitFor(1));
  EXPECT_EQ(stampAfter(1, -100.0), path.messages()[0]->poses.front().header.stamp);
}

TEST_F(FaultsTest, TheMountingIsKnownAfterAJumpBack) {
  publishStatic({transformOf("base_link", "lidar", ros::Time(0), Pose::Identity())});
  setParameter("mapper", "base_frame", "base_link");
  setParameter("mapper", "transform_wait", 5.0);
  start();
  expectJump(Config{}, "kept");
  const Transforms transforms = transformsTo("base_link");
  ASSERT_EQ(kMiddle + kScans - 1, transforms.size());
  EXPECT_EQ(stampAfter(kScans - 1, -100.0), transforms.back().header.stamp);
}

TEST_F(FaultsTest, AMountingOnTfIsFoundAgainAfterAJumpBack) {
  const auto publishMounting = [&](const ros::Time& stamp) {
    publishTf({transformOf("base_link", "lidar", stamp, Pose::Identity())});
  };
  setParameter("mapper", "base_frame", "base_link");
  setParameter("mapper", "transform_wait", 0.2);
  start();
  for (size_t i = 0; i < kMiddle; ++i) {
    publishMounting(scans()[i].header.stamp);
    map({scans()[i]});
  }
  for (size_t i = 0; i < scans().size(); ++i) {
    publishMounting(stampAfter(i, -100.0));
    map({shifted(i, -100.0)});
  }
  EXPECT_EQ("tracked", lastStatus());
}

TEST_F(FaultsTest, DropsWholeScansAndCountsThem) {
  start(1);
  Scans numbered = scans();
  for (size_t i = 0; i < numbered.size(); ++i) {
    numbered[i].number = i;
    numbered[i].dropped = 10;  // before they came here
  }
  for (const VoxelScanStamped& scan : numbered) publish(voxels_, scan);
  EXPECT_TRUE(eventually([&] {  // the last is never dropped
    return reports_.count() > 0 && reports_.messages().back()->number == kScans - 1;
  }));
  const size_t dropped = kScans - reports_.count();
  ASSERT_GT(dropped, 0U);
  Scans used;
  for (const auto& report : reports_.messages()) {
    used.push_back(numbered[report->number]);
    EXPECT_GE(report->dropped, 10U);
    EXPECT_LE(report->dropped, 10U + dropped);
  }
  expectOdometry(posesOf(mapped(used)));
  EXPECT_TRUE(tells("mapper", [&](const Status& s) {
    return s.level >= Status::WARN && hasWords(s.message, {"scans dropped", "slower rate"}) &&
           valueOf(s, "dropped") == std::to_string(dropped);
  }));
  publish(voxels_, scans()[0]);
  ASSERT_TRUE(reports_.waitFor(used.size() + 1));
  EXPECT_EQ(dropped, reports_.messages().back()->dropped);
}

}  // namespace
}  // namespace edgevox::test

int main(int argc, char** argv) { return edgevox::test::runNodeletTests(argc, argv); }
