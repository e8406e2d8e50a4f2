// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversions/voxel_scan_message.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "edgevox/scan/voxelizer.hpp"
#include "tools/cloud_message.hpp"

namespace edgevox {
namespace {

VoxelScan makeScan() {
  Voxelizer voxelizer({}, 0.2);
  VoxelScan scan = voxelizer.voxelize(
      viewOf({{1, 2, 3}, {1.01F, 2, 3}, {-4, 5, -6}, {0.7F, 0, 0}}, 1600000000.25, "lidar"));
  scan.voxels[1].time_offset = -0.04F;
  scan.voxels[2].edge = true;
  scan.dropped = {1, 2, 3, 4};
  return scan;
}

std_msgs::Header headerOf(const VoxelScan& scan) {
  std_msgs::Header header;
  header.frame_id = scan.frame;
  header.stamp.fromSec(scan.stamp);
  return header;
}

VoxelScanStamped makeMessage() { return toMessage(makeScan(), headerOf(makeScan())); }

TEST(VoxelScanMessage, givesTheScanBack) {
  const VoxelScan scan = makeScan();
  const VoxelScan read = fromMessage(makeMessage());
  EXPECT_EQ(scan.stamp, read.stamp);
  EXPECT_EQ(scan.frame, read.frame);
  EXPECT_EQ(scan.number, read.number);
  EXPECT_EQ(scan.voxel_size, read.voxel_size);
  EXPECT_EQ(scan.points_read, read.points_read);
  EXPECT_EQ(scan.dropped.not_finite, read.dropped.not_finite);
  EXPECT_EQ(scan.dropped.too_near, read.dropped.too_near);
  EXPECT_EQ(scan.dropped.too_far, read.dropped.too_far);
  EXPECT_EQ(scan.dropped.bad_time, read.dropped.bad_time);
  ASSERT_EQ(3U, read.voxels.size());
  for (size_t i = 0; i < read.voxels.size(); ++i) {
    EXPECT_EQ(scan.voxels[i].index, read.voxels[i].index);
    EXPECT_EQ(scan.voxels[i].centroid, read.voxels[i].centroid);
    EXPECT_EQ(scan.voxels[i].time_offset, read.voxels[i].time_offset);
    EXPECT_EQ(scan.voxels[i].point_count, read.voxels[i].point_count);
    EXPECT_EQ(scan.voxels[i].edge, read.voxels[i].edge);
  }
}

TEST(VoxelScanMessage, leavesOutImpossibleVoxels) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  VoxelScanStamped message = makeMessage();
  const auto add = [&](const auto& spoil) {
    Voxel voxel = makeMessage().voxels[0];
    spoil(voxel);
    message.voxels.push_back(voxel);
  };
  add([&](Voxel& v) { v.centroid.x = nan; });
  add([&](Voxel& v) { v.centroid.z = -std::numeric_limits<float>::infinity(); });
  add([&](Voxel& v) { v.centroid.y = 1e9F; });
  add([&](Voxel& v) { v.x = std::numeric_limits<int32_t>::min(); });
  add([&](Voxel& v) { v.z = kIndexLimit; });
  add([&](Voxel& v) { v.time_offset = nan; });
  add([&](Voxel& v) { v.time_offset = 3.0F; });
  add([&](Voxel& v) { v.point_count = 0; });
  EXPECT_EQ(3U, fromMessage(message).voxels.size());
}

TEST(VoxelScanMessage, isRefusedWithAStampThatRosCannotCarry) {
  VoxelScanStamped message = makeMessage();
  EXPECT_FALSE(refusalOf(message, {}));
  message.header.stamp.nsec = std::numeric_limits<uint32_t>::max();
  const auto refusal = refusalOf(message, {});
  ASSERT_TRUE(refusal);
  EXPECT_EQ("bad_stamp", refusal->reason);
  EXPECT_NE(std::string::npos, refusal->text.find("4294967295 ns")) << refusal->text;
}

TEST(Refusal, ofMoreVoxelsThanAllowed) {
  Config config;
  config.voxelizer.max_voxels = 60;
  VoxelScanStamped message = makeMessage();
  message.voxels.resize(60, message.voxels.at(0));
  EXPECT_FALSE(refusalOf(message, config));
  message.voxels.push_back(message.voxels.front());
  const auto refusal = refusalOf(message, config);
  ASSERT_TRUE(refusal);
  EXPECT_EQ("too_large", refusal->reason);
  EXPECT_NE(std::string::npos, refusal->text.find("more than 60 voxels")) << refusal->text;
}

TEST(Settings, ofOneConfigurationAgree) {
  Config config;
  config.voxel_size = 0.2;
  VoxelScanStamped message = makeMessage();
  addSettings(config, {"voxel_size", "voxelizer/", "edges/"}, message);
  EXPECT_EQ(14U, message.settings.size());  // without edges/instruction_set
  EXPECT_FALSE(refusalOf(message, config));
  config.threads = 4;
  config.edges.instruction_set = InstructionSet::kPortable;
  config.map.min_hits = 5;  // not of the nodelets before
  EXPECT_FALSE(refusalOf(message, config));
}

TEST(Settings, thatDifferAreNamed) {
  Config config;
  VoxelScanStamped message = makeMessage();
  addSettings(config, {"voxel_size", "voxelizer/", "edges/"}, message);
  Config other = config;
  other.edges.scan.ratio = 0.25;
  const auto refusal = refusalOf(message, other);
  ASSERT_TRUE(refusal);
  EXPECT_EQ("config_mismatch", refusal->reason);
  EXPECT_EQ(0U, refusal->text.find("its parameter 'edges/scan_ratio' is 0.1, here it is 0.25;"))
      << refusal->text;
  Setting unknown;
  unknown.name = "edges/new";
  message.settings.push_back(unknown);
  EXPECT_NE(std::string::npos, refusalOf(message, config)->text.find("'edges/new'"));
}

TEST(Settings, withoutThemTheVoxelSizeIsCompared) {
  Config config;
  EXPECT_FALSE(refusalOf(makeMessage(), config));
  config.voxel_size = 0.1;
  EXPECT_NE(std::string::npos, refusalOf(makeMessage(), config)->text.find("'voxel_size'"));
}

}  // namespace
}  // namespace edgevox
