// SPDX-License-Identifier: BSD-3-Clause
// edgevox/Voxelizer: clouds in, voxels out.
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "edgevox/config.hpp"
#include "ros/conversions/point_cloud.hpp"
#include "ros/nodelet_fixture.hpp"
#include "ros/simulated_scans.hpp"
#include "tools/cloud_message.hpp"
#include "tools/simulated_bag.hpp"

namespace edgevox::test {
namespace {

using Cloud = sensor_msgs::PointCloud2;

const std::vector<Cloud>& clouds() {
  static const std::vector<Cloud> made = simulateRun(4).clouds;
  return made;
}

class VoxelizerTest : public NodeletTest {
 protected:
  void start(int queue_size = 100) {
    setParameter("voxelizer", "queue_size", queue_size);
    ASSERT_TRUE(load("voxelizer"));
    points_ = advertise<Cloud>(resolved("points"), 100);
    ASSERT_EQ(1U, points_.getNumSubscribers());
  }

  void send(const Cloud& cloud) { publishShared(points_, copyOf(cloud)); }

  VoxelScan voxelized(const Cloud& cloud) {
    return Voxelizer(config_.voxelizer, config_.voxel_size).voxelize(viewOf(cloud));
  }

  /// Everything but the number of the message, the times and the counts of the nodelet.
  void expectVoxelsOf(const Cloud& cloud, const VoxelScanStamped& message) {
    const VoxelScan scan = voxelized(cloud);
    EXPECT_TRUE(sameScan(scan, message));
    EXPECT_EQ(cloud.header.stamp, message.header.stamp);
    EXPECT_EQ(cloud.header.frame_id, message.header.frame_id);
    EXPECT_EQ(scan.voxel_size, message.voxel_size);
    EXPECT_EQ(scan.points_read, message.points_read);
    EXPECT_EQ(scan.dropped.not_finite, message.points_not_finite);
    EXPECT_EQ(scan.dropped.too_near, message.points_too_near);
    EXPECT_EQ(scan.dropped.too_far, message.points_too_far);
    EXPECT_EQ(scan.dropped.bad_time, message.points_bad_time);
  }

  Config config_;
  ros::Publisher points_;
  Listener<VoxelScanStamped> voxels_{resolved("voxels")};
};

TEST_F(VoxelizerTest, PublishesWhatTheCoreMakes) {
  config_.voxel_size = 0.3;
  config_.voxelizer = {1.5, 15.0};
  setParameter("voxelizer", "voxel_size", 0.3);
  setParameter("voxelizer", "voxelizer/min_range", 1.5);
  setParameter("voxelizer", "voxelizer/max_range", 15);  // a whole number will do
  start();
  const ros::WallTime before = ros::WallTime::now();
  for (const Cloud& cloud : clouds()) send(cloud);
  ASSERT_TRUE(voxels_.waitFor(clouds().size()));
  const auto messages = voxels_.messages();
  for (size_t i = 0; i < clouds().size(); ++i) {
    const VoxelScanStamped& message = *messages[i];
    ASSERT_GT(message.voxels.size(), 1000U);
    expectVoxelsOf(clouds()[i], message);
    EXPECT_GT(message.points_too_far, 0U);
    EXPECT_EQ(i, message.number);
    EXPECT_EQ("time", message.time_field);
    EXPECT_EQ(0U, message.occupied_voxels + message.edge_voxels + message.sparse_voxels);
    EXPECT_GE(message.arrival.toSec(), before.toSec() - 1e-6);
    EXPECT_LE(message.arrival.toSec(), ros::WallTime::now().toSec());
    EXPECT_GT(message.voxelize_seconds, 0.0F);
    EXPECT_EQ(0U, message.refused + message.dropped);
    const std::vector<std::string> settings = {"voxel_size=0.3",
                                               "voxelizer/min_range=1.5",
                                               "voxelizer/max_range=15",
                                               "voxelizer/max_points=5000000",
                                               "voxelizer/max_voxels=300000",
                                               "voxelizer/time_unit=auto",
                                               "voxelizer/stamp_at=auto"};
    EXPECT_EQ(settings, settingsOf(message));
  }
}

TEST_F(VoxelizerTest, PublishesACloudOfTheCentroidsForWhoListens) {
  start();
  send(clouds()[0]);
  ASSERT_TRUE(voxels_.waitFor(1));
  const Listener<Cloud> listener(resolved("voxels_cloud"));
  send(clouds()[1]);
  ASSERT_TRUE(listener.waitFor(1));
  const Cloud cloud = *listener.messages()[0];
  EXPECT_EQ(clouds()[1].header.stamp, cloud.header.stamp);  // the first is not kept for late ones
  EXPECT_EQ("lidar", cloud.header.frame_id);
  const VoxelScan scan = voxelized(clouds()[1]);
  const auto points = pointsOf(cloud);
  ASSERT_EQ(scan.voxels.size(), points.size());
  for (size_t i = 0; i < points.size(); ++i) ASSERT_EQ(scan.voxels[i].centroid, points[i]) << i;
}

/// A cloud that cannot be read, and the words of the text that says so.
struct BadCloud {
  CloudFault fault;
  std::vector<std::string> words;
  std::function<void(Cloud&)> spoil;
};

std::vector<BadCloud> badClouds() {
  return {
      {CloudFault::kStamp,
       {"4294967267 s", "too late", "driver's clock"},
       [](Cloud& c) { c.header.stamp.sec = 4294967267; }},
      {CloudFault::kEmpty,
       {"no points", "range and filter"},
       [](Cloud& c) {
         c.width = c.row_step = 0;
         c.data.clear();
       }},
      {CloudFault::kBigEndian,
       {"big-endian", "little-endian"},
       [](Cloud& c) { c.is_bigendian = 1; }},
      {CloudFault::kMissingCoordinate,
       {"no field 'z'", "choose a topic"},
       [](Cloud& c) { c.fields[2].name = "depth"; }},
      {CloudFault::kDuplicateCoordinate,
       {"'x'", "correct the driver"},
       [](Cloud& c) { c.fields[1].name = "x"; }},
      {CloudFault::kCoordinateType,
       {"'y' is int32", "must be float32 or float64"},
       [](Cloud& c) { c.fields[1].datatype = Field::INT32; }},
      {CloudFault::kPointStep,
       {"does not fit in point_step", "offsets"},
       [](Cloud& c) { c.fields[2].offset = 14; }},
      {CloudFault::kRowStep,
       {"row_step", "correct the driver"},
       [](Cloud& c) {
         c.height = 2;
         c.row_step /= 2;
       }},
      {CloudFault::kDataSize, {"cut short"}, [](Cloud& c) { c.data.resize(c.data.size() - 1); }},
  };
}

TEST_F(VoxelizerTest, RefusesEveryBadCloudAndGoesOn) {
  start();
  const auto bad = badClouds();
  for (const BadCloud& one : bad) {
    Cloud cloud = clouds()[0];
    one.spoil(cloud);
    send(cloud);
    send(clouds()[1]);
  }
  ASSERT_TRUE(voxels_.waitFor(bad.size()));
  const auto messages = voxels_.messages();
  for (size_t i = 0; i < messages.size(); ++i) {
    expectVoxelsOf(clouds()[1], *messages[i]);
    EXPECT_EQ(2 * i + 1, messages[i]->number);
    EXPECT_EQ(i + 1, messages[i]->refused);
  }
  for (size_t i = 0; i < bad.size(); ++i) {
    std::vector<std::string> words = bad[i].words;
    words.push_back(resolved("voxelizer: cloud ") + std::to_string(2 * i) + " from '" +
                    resolved("points") + "' is refused");
    EXPECT_TRUE(logs(rosgraph_msgs::Log::WARN, words)) << toString(bad[i].fault);
    const std::string key = std::string("refused: ") + toString(bad[i].fault);
    EXPECT_TRUE(tells("voxelizer", [&](const Status& s) { return valueOf(s, key) == "1"; })) << key;
  }
  EXPECT_TRUE(tells("voxelizer", Status::WARN, {"clouds refused", "cut short"}));
  const std::string all = std::to_string(bad.size());
  EXPECT_TRUE(tells("voxelizer", [&](const Status& s) {  // nothing new: no warning
    return s.level == Status::OK && valueOf(s, "refused") == all;
  }));
}

TEST_F(VoxelizerTest, TakesTheUsablePointsOfACloud) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInf = std::numeric_limits<float>::infinity();
  constexpr float kMax = std::numeric_limits<float>::max();
  const std::vector<std::vector<Eigen::Vector3f>> kinds = {
      {{kNan, kNan, kNan}, {1, kNan, 2}, {kInf, 1, 1}},
      {{0.1F, 0, 0}, {0, 0, 0}, {0, 500, 0}},
      {{kMax, kMax, -kMax}, {1e30F, 0, 0}, {-3e9F, 1, 1}},
      {{kNan, 1, 1}, {3e9F, 1, 1}, {2, 3, 1}, {0, 0, 0}},
  };
  start();
  for (const auto& points : kinds) {
    send(makeCloud(points));
    send(clouds()[1]);
  }
  ASSERT_TRUE(voxels_.waitFor(2 * kinds.size()));
  const auto messages = voxels_.messages();
  for (size_t i = 0; i < kinds.size(); ++i) {
    expectVoxelsOf(makeCloud(kinds[i]), *messages[2 * i]);
    expectVoxelsOf(clouds()[1], *messages[2 * i + 1]);
  }
  EXPECT_EQ(3U, messages[0]->points_not_finite);
  EXPECT_EQ(2U, messages[2]->points_too_near);
  EXPECT_EQ(1U, messages[2]->points_too_far);
  EXPECT_EQ(3U, messages[4]->points_too_far);
  EXPECT_EQ(1U, messages[6]->voxels.size());
  for (const size_t i : {0U, 2U, 4U}) EXPECT_TRUE(messages[i]->voxels.empty());
  EXPECT_TRUE(tells("voxelizer", [](const Status& s) {
    return valueOf(s, "points not finite") == "4" && valueOf(s, "points too near") == "3" &&
           valueOf(s, "refused") == "0";
  }));
}

TEST_F(VoxelizerTest, WarnsOfTimesThatItDoesNotUnderstand) {
  start();
  Cloud cloud = clouds()[0];
  cloud.fields[3].datatype = Field::INT32;
  send(cloud);
  ASSERT_TRUE(voxels_.waitFor(1));
  EXPECT_EQ("", voxels_.messages()[0]->time_field);
  EXPECT_TRUE(tells("voxelizer", Status::WARN, {"times are not used", "'time' is int32"}));
}

TEST_F(VoxelizerTest, DropsWholeCloudsAndCountsThem) {
  constexpr size_t kSent = 60;
  constexpr size_t kWaiting = 3;
  start(kWaiting);
  std::vector<Cloud::ConstPtr> sent;  // made before the first is sent
  for (size_t i = 0; i < kSent; ++i) {
    sent.push_back(copyOf(stamped(clouds()[i % 4], stampOf(double(i)))));
  }
  for (const auto& cloud : sent) publishShared(points_, cloud);

  const auto last_is_there = [&] {
    const auto messages = voxels_.messages();
    return !messages.empty() && messages.back()->number == kSent - 1;
  };
  ASSERT_TRUE(eventually(last_is_there));
  const auto messages = voxels_.messages();
  const size_t dropped = kSent - messages.size();
  ASSERT_GT(dropped, 0U);
  for (const auto& message : messages) {
    expectVoxelsOf(*sent[message->number], *message);
    EXPECT_LE(message->dropped, dropped);
  }
  for (size_t i = 1; i <= kWaiting; ++i) {  // the oldest go
    EXPECT_EQ(kSent - i, messages.at(messages.size() - i)->number);
  }
  EXPECT_TRUE(tells("voxelizer", [&](const Status& s) {
    return s.level == Status::WARN && hasWords(s.message, {"dropped", "larger voxel_size"}) &&
           valueOf(s, "dropped") == std::to_string(dropped);
  }));
  EXPECT_TRUE(logs(rosgraph_msgs::Log::WARN, {resolved("points"), "dropped"}));
  send(clouds()[0]);
  ASSERT_TRUE(voxels_.waitFor(messages.size() + 1));
  EXPECT_EQ(dropped, voxels_.messages().back()->dropped);
}

}  // namespace
}  // namespace edgevox::test

int main(int argc, char** argv) { return edgevox::test::runNodeletTests(argc, argv); }
