// SPDX-License-Identifier: BSD-3-Clause
// edgevox/EdgeExtractor: voxels in, the same with the edges marked out.
#include <sensor_msgs/PointCloud2.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "edgevox/config.hpp"
#include "edgevox/edges/density_monitor.hpp"
#include "edgevox/edges/edge_extractor.hpp"
#include "edgevox/scan/voxelizer.hpp"
#include "ros/conversions/voxel_scan_message.hpp"
#include "ros/nodelet_fixture.hpp"
#include "ros/simulated_scans.hpp"
#include "tools/simulated_bag.hpp"

namespace edgevox::test {
namespace {

const std::vector<VoxelScan>& scans() {
  static const std::vector<VoxelScan> made = [] {
    const Config config;
    Voxelizer voxelizer(config.voxelizer, config.voxel_size);
    std::vector<VoxelScan> all;
    for (const auto& cloud : simulateRun(4).clouds)
      all.push_back(voxelizer.voxelize(viewOf(cloud)));
    return all;
  }();
  return made;
}

/// As a voxelizer sends it.
VoxelScanStamped messageOf(const VoxelScan& scan, const Config& config = {}) {
  std_msgs::Header header;
  header.stamp.fromSec(scan.stamp);
  header.frame_id = scan.frame;
  VoxelScanStamped message = toMessage(scan, header);
  message.time_field = "time";
  message.arrival = ros::Time(1234, 5678);
  message.voxelize_seconds = 0.25F;
  message.refused = 3;
  message.dropped = 7;
  addSettings(config, {"voxel_size", "voxelizer/"}, message);
  return message;
}

class EdgeExtractorTest : public NodeletTest {
 protected:
  void start(int queue_size = 100) {
    setParameter("edge_extractor", "queue_size", queue_size);
    ASSERT_TRUE(load("edge_extractor"));
    voxels_ = advertise<VoxelScanStamped>(resolved("voxels"), 100);
    ASSERT_EQ(1U, voxels_.getNumSubscribers());
  }

  void send(const VoxelScanStamped& scan) { publishShared(voxels_, copyOf(scan)); }

  /// Sends it and waits for what comes of it.
  VoxelScanStamped edgesOf(const VoxelScanStamped& scan) {
    const size_t before = edges_.count();
    send(scan);
    EXPECT_TRUE(edges_.waitFor(before + 1));
    return edges_.count() > before ? *edges_.messages().back() : VoxelScanStamped();
  }

  /// A scan after which the next good one is the first that comes out.
  void expectNothingOf(const VoxelScanStamped& scan) {
    const size_t before = edges_.count();
    send(scan);
    edgesOf(messageOf(scans()[0]));
    EXPECT_EQ(before + 1, edges_.count());
  }

  /// The same, and an ERROR of these words in between.
  void expectRefused(const VoxelScanStamped& scan, const std::vector<std::string>& words) {
    send(scan);
    EXPECT_TRUE(tells("edge_extractor", Status::ERROR, words));
    expectNothingOf(scan);
  }

  Config config_;
  ros::Publisher voxels_;
  Listener<VoxelScanStamped> edges_{resolved("edges")};
};

TEST_F(EdgeExtractorTest, MarksTheEdgesThatTheCoreFinds) {
  config_.edges.scan.ratio = 0.2;
  setParameter("edge_extractor", "edges/scan_ratio", 0.2);
  setParameter("edge_extractor", "threads", 2);
  start();
  EdgeExtractor extractor(config_.edges, 1);
  for (const VoxelScan& sent : scans()) {
    VoxelScan scan = sent;
    const EdgeCount count = extractor.extract(scan);
    ASSERT_GT(count.edges, 100U);
    const VoxelScanStamped message = edgesOf(messageOf(sent));
    EXPECT_TRUE(sameScan(scan, message));
    EXPECT_EQ(count.occupied, message.occupied_voxels);
    EXPECT_EQ(count.edges, message.edge_voxels);
    EXPECT_EQ(count.sparse, message.sparse_voxels);
    EXPECT_GT(message.extract_seconds, 0.0F);
  }
  EXPECT_EQ(scans().size(), edges_.count());
  EXPECT_TRUE(tells("edge_extractor", Status::OK, {"edge voxels of"}));
}

TEST_F(EdgeExtractorTest, LeavesTheRestOfTheMessageAlone) {
  start();
  const VoxelScanStamped sent = messageOf(scans()[2]);
  VoxelScanStamped message = edgesOf(sent);
  auto settings = settingsOf(sent);
  for (const char* setting : {"edges/mode=default", "edges/magnitude=0.1", "edges/scan_ratio=0.1",
                              "edges/scan_support=0.35", "edges/map_ratio=0.15",
                              "edges/map_support=0.5", "edges/map_neighbours=8"}) {
    settings.push_back(setting);
  }
  EXPECT_EQ(settings, settingsOf(message));
  message.settings = sent.settings;
  message.voxels = sent.voxels;
  message.extract_seconds = 0.0F;
  message.occupied_voxels = message.edge_voxels = message.sparse_voxels = 0;
  EXPECT_EQ(sent, message);
}

TEST_F(EdgeExtractorTest, WarnsOfVoxelsSmallerThanTheGapsAndNamesASize) {
  config_.voxel_size = 0.02;
  setParameter("edge_extractor", "voxel_size", config_.voxel_size);
  start();
  VoxelScan scan =
      Voxelizer(config_.voxelizer, config_.voxel_size).voxelize(viewOf(simulateRun(1).clouds[0]));
  DensityMonitor alarm(config_.edges, 1, DensityMonitor::kEveryScan);
  alarm.add(scan, EdgeExtractor(config_.edges, 1).extract(scan));
  ASSERT_TRUE(alarm.warning());
  ASSERT_GT(alarm.warning()->voxel_size, config_.voxel_size);
  const std::string text = textOf(*alarm.warning());
  edgesOf(messageOf(scan, config_));
  EXPECT_TRUE(tells("edge_extractor", Status::WARN, {text}));
  EXPECT_TRUE(logs(rosgraph_msgs::Log::WARN, {text}));
  for (int i = 0; i < 5; ++i) edgesOf(messageOf(scan, config_));
  EXPECT_EQ(1U, countLogged(rosgraph_msgs::Log::WARN, {"too sparse"})) << "not throttled";
}

TEST_F(EdgeExtractorTest, TellsTheShareOfSparseVoxels) {
  start();
  VoxelScan scan = scans()[0];
  const double share = EdgeExtractor(config_.edges, 1).extract(scan).sparseShare();
  ASSERT_GT(share, 0.0);
  edgesOf(messageOf(scans()[0]));
  EXPECT_TRUE(tells("edge_extractor", [&](const Status& s) {
    const std::string told = valueOf(s, "sparse voxels, median share");
    return s.level == Status::OK && !told.empty() && std::abs(std::stod(told) - share) < 6e-4;
  }));
}

TEST_F(EdgeExtractorTest, PublishesACloudOfTheEdgesForWhoListens) {
  start();
  edgesOf(messageOf(scans()[0]));
  const Listener<sensor_msgs::PointCloud2> listener(resolved("edges_cloud"));
  const VoxelScanStamped message = edgesOf(messageOf(scans()[1]));
  ASSERT_TRUE(listener.waitFor(1));
  const auto cloud = *listener.messages()[0];
  EXPECT_EQ(message.header, cloud.header);
  const auto points = pointsOf(cloud);
  size_t next = 0;
  for (const Voxel& voxel : message.voxels) {
    if (!voxel.edge) continue;
    ASSERT_LT(next, points.size());
    ASSERT_TRUE(same(points[next++], voxel.centroid));
  }
  EXPECT_GT(next, 100U);
  EXPECT_EQ(next, points.size());
}

TEST_F(EdgeExtractorTest, RefusesScansOfAnotherConfigurationAndNamesTheParameter) {
  start();
  Config other;
  other.voxelizer.max_range = 60.0;
  expectRefused(messageOf(scans()[0], other),
                {"'voxelizer/max_range' is 60", "here it is 120", "the same configuration"});
  VoxelScanStamped coarse = messageOf(scans()[0]);
  coarse.settings.clear();
  coarse.voxel_size = 0.2;
  expectRefused(coarse, {"'voxel_size' is 0.4", "here it is 0.2"});
  coarse.voxel_size = std::numeric_limits<double>::quiet_NaN();
  expectNothingOf(coarse);
  other = {};
  other.edges.scan.ratio = 0.3;
  VoxelScanStamped marked = messageOf(scans()[0]);
  addSettings(other, {"edges/"}, marked);
  expectRefused(marked, {"'edges/scan_ratio' is 0.3", "here it is 0.1"});
  VoxelScanStamped future = messageOf(scans()[0]);
  future.settings.emplace_back().name = "voxelizer/stride";
  expectNothingOf(future);
  EXPECT_TRUE(logs(rosgraph_msgs::Log::WARN, {resolved("voxels"), "are refused", "max_range"}));
  EXPECT_TRUE(tells("edge_extractor", Status::OK, {"edge voxels of"}));  // the last one is good
}

TEST_F(EdgeExtractorTest, RefusesAndCountsBadStamps) {
  start();
  VoxelScanStamped scan = messageOf(scans()[0]);
  scan.header.stamp.sec = std::numeric_limits<uint32_t>::max();
  expectRefused(scan, {"4294967295 s", "too late", "correct the clock"});
  scan.header.stamp = ros::Time();
  expectNothingOf(scan);
  EXPECT_TRUE(logs(rosgraph_msgs::Log::WARN, {resolved("voxels"), "are refused", "too late"}));
  EXPECT_TRUE(tells("edge_extractor", [](const Status& s) {
    return s.level == Status::OK && valueOf(s, "refused: bad_stamp") == "3";
  }));
}

TEST_F(EdgeExtractorTest, DoesNotCompareWhatChangesNoResult) {
  start();
  VoxelScanStamped scan = messageOf(scans()[0]);
  for (const char* name : {"threads", "edges/instruction_set"}) {
    Setting& setting = scan.settings.emplace_back();
    setting.name = name;
    setting.value = "portable";
  }
  EXPECT_GT(edgesOf(scan).edge_voxels, 100U);
}

/// Voxels that no voxelizer makes.
std::vector<Voxel> impossibleVoxels() {
  Voxel good;
  good.point_count = 1;
  std::vector<Voxel> bad(8, good);
  bad[0].centroid.x = std::numeric_limits<float>::quiet_NaN();
  bad[1].centroid.z = std::numeric_limits<float>::infinity();
  bad[2].centroid.y = 1e30F;
  bad[3].x = kIndexLimit;
  bad[4].y = std::numeric_limits<int32_t>::min();
  bad[5].time_offset = 1e9F;
  bad[6].time_offset = std::numeric_limits<float>::quiet_NaN();
  bad[7].point_count = 0;
  for (size_t i = 0; i < bad.size(); ++i) bad[i].edge = 1;
  return bad;
}

TEST_F(EdgeExtractorTest, LeavesImpossibleVoxelsOut) {
  start();
  const VoxelScanStamped good = edgesOf(messageOf(scans()[0]));
  VoxelScanStamped mixed = messageOf(scans()[0]);
  const auto bad = impossibleVoxels();
  constexpr size_t kStep = 100;
  for (size_t i = 0; i < bad.size(); ++i) {
    mixed.voxels.insert(mixed.voxels.begin() + static_cast<std::ptrdiff_t>(kStep * i), bad[i]);
  }
  VoxelScanStamped message = edgesOf(mixed);
  ASSERT_EQ(mixed.voxels.size(), message.voxels.size());
  EXPECT_EQ(good.edge_voxels, message.edge_voxels);
  for (size_t i = bad.size(); i-- > 0;) {
    const auto at = message.voxels.begin() + static_cast<std::ptrdiff_t>(kStep * i);
    EXPECT_FALSE(at->edge) << i;
    message.voxels.erase(at);
  }
  EXPECT_TRUE(good.voxels == message.voxels);
}

TEST_F(EdgeExtractorTest, LeavesAnImpossibleVoxelInThePlaceOfAnotherOut) {
  start();
  const VoxelScanStamped good = edgesOf(messageOf(scans()[0]));
  const auto is_edge = [](const Voxel& v) { return v.edge != 0; };
  const auto edge = std::find_if(good.voxels.begin(), good.voxels.end(), is_edge);
  ASSERT_NE(good.voxels.end(), edge);
  VoxelScanStamped mixed = messageOf(scans()[0]);
  const auto at = mixed.voxels.begin() + (edge - good.voxels.begin());
  Voxel bad = *at;
  bad.centroid.y = std::numeric_limits<float>::quiet_NaN();
  mixed.voxels.insert(at, bad);
  VoxelScanStamped message = edgesOf(mixed);
  const auto bad_at = message.voxels.begin() + (edge - good.voxels.begin());
  EXPECT_FALSE(bad_at->edge);
  message.voxels.erase(bad_at);
  EXPECT_TRUE(good.voxels == message.voxels);
}

TEST_F(EdgeExtractorTest, TakesScansOfNothingAndOfImpossibleVoxelsOnly) {
  start();
  VoxelScanStamped scan = messageOf(scans()[0]);
  scan.voxels = impossibleVoxels();
  EXPECT_EQ(0U, edgesOf(scan).edge_voxels);
  scan.voxels.clear();
  EXPECT_EQ(0U, edgesOf(scan).occupied_voxels);
  EXPECT_GT(edgesOf(messageOf(scans()[1])).edge_voxels, 100U);
}

TEST_F(EdgeExtractorTest, AddsItsDropsToThoseOfTheVoxelizer) {
  constexpr size_t kSent = 60;
  start(1);
  const auto scan = copyOf(messageOf(scans()[0]));
  for (size_t i = 0; i < kSent; ++i) publishShared(voxels_, scan);
  EXPECT_TRUE(tells("edge_extractor", [&](const Status& s) {
    const size_t dropped = kSent - edges_.count();
    return s.level == Status::WARN && dropped > 0 && hasWords(s.message, {"scans dropped"}) &&
           valueOf(s, "received") == std::to_string(kSent) &&
           valueOf(s, "dropped") == std::to_string(dropped);
  }));
  const uint64_t dropped = kSent - edges_.count();
  EXPECT_EQ(7 + dropped, edgesOf(*scan).dropped);
}

}  // namespace
}  // namespace edgevox::test

int main(int argc, char** argv) { return edgevox::test::runNodeletTests(argc, argv); }
