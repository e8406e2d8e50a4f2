// SPDX-License-Identifier: BSD-3-Clause
// mapping.launch and localization.launch give what map_bag gives, with their own player and with
// rosbag play.
#include <edgevox/SaveMap.h>
#include <edgevox/ScanReport.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/param.h>
#include <rosbag/bag.h>
#include <sensor_msgs/PointCloud2.h>
#include <yaml-cpp/yaml.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "edgevox/io/trajectory_io.hpp"
#include "ros/conversions/pose_messages.hpp"
#include "ros/launch_fixture.hpp"
#include "ros/launch_graph.hpp"
#include "ros/launch_run.hpp"
#include "ros/topics.hpp"
#include "sim/worlds.hpp"
#include "support/sweeps.hpp"
#include "tools/cloud_message.hpp"
#include "tools/map_bag_fixture.hpp"
#include "tools/simulated_bag.hpp"

namespace edgevox::test {
namespace {

using sensor_msgs::PointCloud2;
using Joints = std::set<FrameTree::Joint>;

const std::vector<PointCloud2>& goodClouds() { return simulatedRun().clouds; }

Pose mounting() {
  Pose T_base_sensor(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()));
  T_base_sensor.translation() = Eigen::Vector3d(0.3, 0.1, 0.8);
  return T_base_sensor;
}

/// base_link -> lidar, half a second before the first cloud: the bag begins with it.
void writeMounting(rosbag::Bag& bag) {
  const ros::Time before = goodClouds().front().header.stamp - ros::Duration(0.5);
  writeTransform(bag, "/tf_static", before, transformOf("base_link", "lidar", before, mounting()));
}

/// odom -> base_link at 50 Hz with some drift, early enough for a slow computer.
void writeOdometry(rosbag::Bag& bag) {
  const sim::Trajectory path = sim::makeTrajectory(sim::WorldName::Building, sim::makeSensor("32"));
  const ros::Time first = goodClouds().front().header.stamp;
  const ros::Time end = goodClouds().back().header.stamp + ros::Duration(0.05);
  Pose T_odom_world(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
  T_odom_world.translation() = Eigen::Vector3d(10, -5, 0);
  for (ros::Time t = first - ros::Duration(0.053); t < end; t += ros::Duration(0.02)) {
    Pose T_world_lidar = path.poseAt((t - stampOf(0)).toSec());
    T_world_lidar.translation().x() += 0.03 * (t - first).toSec();
    const Pose T_odom_base = T_odom_world * T_world_lidar * mounting().inverse();
    writeTransform(bag, "/tf", t - ros::Duration(0.05),
                   transformOf("odom", "base_link", t, T_odom_base));
  }
}

/// Each bad in its own way, to stand behind the good one of the same number.
std::vector<PointCloud2> badClouds() {
  std::vector<PointCloud2> bad(goodClouds().begin(), goodClouds().begin() + 8);
  for (PointCloud2& cloud : bad) cloud.header.stamp += ros::Duration(0.03);
  bad[0].fields.erase(bad[0].fields.begin());
  bad[1].data.resize(100);
  bad[2].width = 0;
  bad[3].header.frame_id = "other";
  bad[4].header.stamp = goodClouds()[4].header.stamp;
  bad[5].header.stamp -= ros::Duration(0.8);
  for (size_t i = 0; i < bad[6].width; ++i) {
    put(bad[6], 0, i, 4, std::numeric_limits<float>::quiet_NaN());
  }
  bad[7].width = 1;
  bad[7].row_step = bad[7].point_step;
  bad[7].data.resize(bad[7].point_step);
  return bad;
}

std::vector<PointCloud2> goodAndBadClouds() {
  std::vector<PointCloud2> clouds;
  const std::vector<PointCloud2> bad = badClouds();
  for (size_t i = 0; i < goodClouds().size(); ++i) {
    clouds.push_back(goodClouds()[i]);
    if (i < bad.size()) clouds.push_back(bad[i]);
  }
  return clouds;
}

class Launch : public LaunchTest {
 protected:
  struct Contents {
    bool mounting = false;
    bool odometry = false;
    bool other_clouds = false;
  };

  void writeBag(const std::vector<PointCloud2>& clouds, const Contents& contents) const {
    rosbag::Bag bag(offline_.bag, rosbag::bagmode::Write);
    ros::Time received = clouds.front().header.stamp;
    if (contents.mounting) writeMounting(bag);
    if (contents.odometry) writeOdometry(bag);
    if (contents.other_clouds) bag.write("/other", received, clouds[3]);
    for (const PointCloud2& cloud : clouds) {
      bag.write("/points", received, cloud);
      received += ros::Duration(0.1);
    }
  }

  /// By three seconds, as on a slow computer.
  void delayTheMapper() {
    std::string text = contentOf(launch_file_);
    const size_t at = text.find("args=\"load edgevox/$(arg tracker_type)");
    ASSERT_NE(at, std::string::npos);
    text.insert(at,
                "launch-prefix=\"sh -c 'sleep 3 &amp;&amp; exec &quot;$0&quot; &quot;$@&quot;'\" ");
    launch_file_ = (folder_ / "mapping.launch").string();
    std::ofstream(launch_file_) << text;
  }

  /// As in a terminal of its own beside mapping.launch.
  void feedWithRosbag(const Words& options) {
    ros::NodeHandle handle;
    int reports = 0;
    const ros::Subscriber subscriber = handle.subscribe<ScanReport>(
        "/edgevox/scan_report", 100, [&](const ScanReport::ConstPtr&) { ++reports; });
    const auto is_ready = [&] {
      return isMapping("/edgevox") && subscriber.getNumPublishers() > 0;
    };
    ASSERT_TRUE(waitFor(is_ready));
    Words command = {"rosbag", "play", "--quiet", "--wait-for-subscribers", "run.bag"};
    command.insert(command.end(), options.begin(), options.end());
    const auto player = start(command);
    ASSERT_TRUE(waitFor([&] { return reports == kSweeps; })) << reports << " reports";
  }

  /// Then saves the map.
  void playWithRosbag(const Words& options) {
    feedWithRosbag(options);
    SaveMap save;
    ASSERT_TRUE(callService("/edgevox/save_map", save));
    EXPECT_TRUE(save.response.success) << save.response.message;
  }

  FrameTree tree_;
};

TEST_F(Launch, playsABagWhenTheMapperIsThere) {
  writeBag(goodClouds(), {true, false, false});
  delayTheMapper();
  launchToTheEnd({"bag:=run.bag", "output:=out", "exit_at_end:=true"});
  expectSameAsOffline();
  EXPECT_TRUE(logged("12 clouds reached the mapper: ")) << "no summary";
  EXPECT_EQ(tree_.joints(), (Joints{{"map", "base_link"}, {"base_link", "lidar"}}));
}

TEST_F(Launch, playsAPartOfABagWithOdometryAndAPreset) {
  writeBag(goodClouds(), {true, true, false});
  offline_.config = "indoor";
  offline_.frames = {"base_link", "odom"};
  offline_.skipped = {{0, 3}, {10, kSweeps - 1}};
  launchToTheEnd({"bag:=run.bag", "output:=out", "exit_at_end:=true", "base_frame:=base_link",
                  "odom_frame:=odom", "config:=indoor", "start:=0.81", "duration:=0.6",
                  "rate:=0.8"});
  expectSameAsOffline();
  EXPECT_EQ(summaryOf(folder_ / "out")["scans"].as<int>(), 6);
  EXPECT_EQ(tree_.joints(),
            (Joints{{"map", "odom"}, {"odom", "base_link"}, {"base_link", "lidar"}}));
}

TEST_F(Launch, badCloudsChangeNothing) {
  writeBag(goodAndBadClouds(), {true, false, true});
  std::ofstream(folder_ / "mine.yaml") << "voxel_size: 0.25\nmap: {min_hits: 1}\n";
  offline_.config = (folder_ / "mine.yaml").string();
  offline_.topic = "/points";
  launchToTheEnd({"bag:=run.bag", "points:=/points", "output:=out", "exit_at_end:=true",
                  "config:=mine.yaml", "bag_tf:=false"});
  expectSameAsOffline();
  EXPECT_EQ(tree_.joints(), (Joints{{"map", "lidar"}}));
  const YAML::Node summary = summaryOf(folder_ / "out");
  EXPECT_EQ(summary["refused"].as<int>(), 3);
  EXPECT_EQ(summary["clouds_left_out"]["other_frame"].as<int>(), 1);

  writeBag(goodClouds(), {});
  mapOffline(offline_);
  expectSameFiles(folder_ / "out", offline_.output);
}

/// The mapper takes the edges of the edge extractor, not the voxels of the voxelizer.
TEST_F(Launch, mapsEdgesAsPublished) {
  writeBag(goodClouds(), {});
  offline_.config = "paper";
  launchToTheEnd({"bag:=run.bag", "output:=out", "exit_at_end:=true", "config:=paper"});
  expectSameAsOffline();
  EXPECT_EQ(readTum(folder_ / "out/trajectory.tum").size(), goodClouds().size());
}

TEST_F(Launch, mapsWhatRosbagPlays) {
  writeBag(goodClouds(), {true, false, false});
  offline_.frames.base = "base_link";
  const auto roslaunch = launch({"output:=out", "base_frame:=base_link"});
  playWithRosbag({});
  expectSameAsOffline();
  roslaunch->interrupt();
  EXPECT_TRUE(roslaunch->waitForEnd(30));
  EXPECT_EQ(tree_.joints(), (Joints{{"map", "base_link"}, {"base_link", "lidar"}}));
}

TEST_F(Launch, savesAtCtrlC) {
  writeBag(goodClouds(), {});
  const auto roslaunch = launch({"output:=out"});
  feedWithRosbag({});
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
  roslaunch->interrupt();
  EXPECT_TRUE(roslaunch->waitForEnd(30));
  expectSameAsOffline();
}

TEST_F(Launch, saysAtCtrlCThatNothingIsSaved) {
  writeBag(goodClouds(), {});
  const auto roslaunch = launch({});
  feedWithRosbag({});
  roslaunch->interrupt();
  EXPECT_TRUE(roslaunch->waitForEnd(30));
  EXPECT_TRUE(logged("the map of 12 scans is not saved: output is not set")) << log();
}

TEST_F(Launch, endsIfItsManagerIsKilled) {
  const auto roslaunch = launch({});
  ASSERT_TRUE(waitFor([] { return isMapping("/edgevox"); }));
  EXPECT_EQ(std::system("kill -9 $(rosnode info /edgevox/manager 2>&1 | sed -n 's/^Pid: //p')"), 0);
  EXPECT_TRUE(roslaunch->waitForEnd(30));
  EXPECT_TRUE(logged("REQUIRED process [edgevox/manager-1] has died")) << log();
}

TEST_F(Launch, playsBagsOneAfterAnotherWhateverTheirNames) {
  const std::filesystem::path folder = folder_ / "it's";
  std::filesystem::create_directory(folder);
  const auto half = goodClouds().begin() + kSweeps / 2;
  writeBag({goodClouds().begin(), half}, {});
  std::filesystem::rename(offline_.bag, folder / "a 0.bag");
  writeBag({half, goodClouds().end()}, {});
  std::filesystem::rename(offline_.bag, folder / "a 1.bag");
  writeBag(goodClouds(), {});
  launchToTheEnd({"bag:=\"it's/a 0.bag\" \"it's/a 1.bag\"", "output:=out", "exit_at_end:=true"});
  expectSameAsOffline();
}

TEST_F(Launch, mapsWhatRosbagPlaysWithItsClock) {
  writeBag(goodClouds(), {true, true, false});
  offline_.frames = {"base_link", "odom"};
  ros::param::set("/use_sim_time", true);
  const auto roslaunch = launch({"output:=out", "base_frame:=base_link", "odom_frame:=odom"});
  playWithRosbag({"--clock"});
  expectSameAsOffline();
}

TEST_F(Launch, localizesInAMapThatAnotherProcessHasSaved) {
  writeBag(goodClouds(), {true, false, false});
  launchToTheEnd({"bag:=run.bag", "output:=out", "exit_at_end:=true", "base_frame:=base_link"});
  const std::string map = contentOf(folder_ / "out/map.edgevox");
  const Trajectory mapped = readTum(folder_ / "out/trajectory.tum");
  std::vector<nav_msgs::Odometry> located;
  const ros::Subscriber subscriber = ros::NodeHandle().subscribe<nav_msgs::Odometry>(
      "/edgevox/odom", 100,
      [&](const nav_msgs::Odometry::ConstPtr& message) { located.push_back(*message); });
  tree_.clear();
  launch_file_ = EDGEVOX_SOURCE_DIR "/launch/localization.launch";
  launchToTheEnd(
      {"map:=out/map.edgevox", "bag:=run.bag", "exit_at_end:=true", "base_frame:=base_link"});
  ASSERT_EQ(located.size(), mapped.size());
  for (size_t i = 0; i < mapped.size(); ++i) {
    EXPECT_NEAR(located[i].header.stamp.toSec(), mapped[i].stamp, 1e-6);
    const PoseDifference off = differenceOf(mapped[i].pose, poseOf(located[i].pose.pose));
    EXPECT_LT(off.metres, 0.02) << i;
    EXPECT_LT(off.degrees, 0.2) << i;
  }
  EXPECT_TRUE(contentOf(folder_ / "out/map.edgevox") == map);
  EXPECT_EQ(tree_.joints(), (Joints{{"map", "base_link"}, {"base_link", "lidar"}}));
}

TEST_F(Launch, goesOnWithAMap) {
  constexpr size_t kHalf = kSweeps / 2;
  MapBagOptions first = offline_;
  first.bag = (folder_ / "first.bag").string();
  first.output = folder_ / "first";
  first.full = true;
  writeBag({goodClouds().begin(), goodClouds().begin() + kHalf}, {});
  std::filesystem::rename(offline_.bag, first.bag);
  mapOffline(first);
  writeBag({goodClouds().begin() + kHalf, goodClouds().end()}, {});
  launchToTheEnd({"bag:=run.bag", "map:=first/map.edgevox", "output:=out", "exit_at_end:=true"});
  offline_.map = (folder_ / "first/map.edgevox").string();
  expectSameAsOffline();
}

TEST_F(Launch, endsIfItsMapCannotBeRead) {
  writeBag(goodClouds(), {});
  launchToTheEnd({"bag:=run.bag", "map:=none.edgevox", "exit_at_end:=true"});
  EXPECT_TRUE(logged("none.edgevox")) << log();
}

TEST_F(Launch, endsIfAParameterIsWrong) {
  writeBag(goodClouds(), {});
  std::ofstream(folder_ / "wrong.yaml") << "matcher: {search_points: 1}\n";
  launchToTheEnd({"bag:=run.bag", "exit_at_end:=true", "config:=wrong.yaml"});
  EXPECT_TRUE(logged("parameter 'matcher/search_points' is '1'"));
}

}  // namespace
}  // namespace edgevox::test

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "launch_test");
  const ros::NodeHandle connected;
  return RUN_ALL_TESTS();
}
