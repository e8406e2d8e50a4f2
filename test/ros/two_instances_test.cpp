// SPDX-License-Identifier: BSD-3-Clause
// Two mappings at a time do not touch each other.
#include <gtest/gtest.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/param.h>
#include <rosbag/bag.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <array>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "ros/launch_feeder.hpp"
#include "ros/launch_graph.hpp"
#include "ros/launch_process.hpp"
#include "ros/launch_run.hpp"
#include "ros/topics.hpp"
#include "tools/map_bag_fixture.hpp"
#include "tools/simulated_bag.hpp"

namespace edgevox::test {
namespace {

using sensor_msgs::PointCloud2;

constexpr size_t kClouds = kSweeps / 2;

/// Every other cloud of the simulated run.
std::vector<PointCloud2> cloudsOf(size_t first, const std::string& frame) {
  std::vector<PointCloud2> clouds;
  for (size_t i = first; i < simulatedRun().clouds.size(); i += 2) {
    clouds.push_back(simulatedRun().clouds[i]);
    clouds.back().header.frame_id = frame;
  }
  return clouds;
}

geometry_msgs::TransformStamped mountingOfB(const ros::Time& stamp) {
  Pose T_base_sensor(Eigen::AngleAxisd(-0.4, Eigen::Vector3d::UnitZ()));
  T_base_sensor.translation() = Eigen::Vector3d(0, 0.2, 1);
  return transformOf("base_b", "lidar_b", stamp, T_base_sensor);
}

class TwoInstances : public MapBagTest {
 protected:
  TwoInstances() {
    static_ = advertise<tf2_msgs::TFMessage>("/tf_static", 1, true);
    tf2_msgs::TFMessage message;
    message.transforms.push_back(mountingOfB(clouds_b_.front().header.stamp));
    publish(static_, message);
  }

  void feedBoth() {
    ASSERT_TRUE(a_.connect("lidar_a"));
    ASSERT_TRUE(b_.connect("lidar_b"));
    for (size_t i = 0; i < kClouds; ++i) {
      ASSERT_TRUE(a_.feed(clouds_a_[i]));
      ASSERT_TRUE(b_.feed(clouds_b_[i]));
    }
  }

  void mapOfflineA() {
    MapBagOptions options = options_;
    options.output = folder_ / "offline_a";
    writeBag(clouds_a_);
    mapOffline(options);
  }

  void mapOfflineB() {
    MapBagOptions options = options_;
    options.output = folder_ / "offline_b";
    options.config = "indoor";
    options.frames.base = "base_b";
    {
      const ros::Time stamp = clouds_b_.front().header.stamp;
      rosbag::Bag bag(options.bag, rosbag::bagmode::Write);
      writeTransform(bag, "/tf_static", stamp, mountingOfB(stamp));
      writeClouds(bag, "/points", clouds_b_);
    }
    mapOffline(options);
  }

  FrameTree tree_;
  std::vector<PointCloud2> clouds_a_ = cloudsOf(0, "lidar_a");
  std::vector<PointCloud2> clouds_b_ = cloudsOf(1, "lidar_b");
  ros::Publisher static_;
  Feeder a_{"/a", "/points_a"};
  Feeder b_{"/b", "/points_b"};
};

void expectFrames(const std::vector<ScanReport>& reports, const std::string& frame) {
  EXPECT_EQ(reports.size(), kClouds);
  for (const ScanReport& report : reports) EXPECT_EQ(report.header.frame_id, frame);
}

TEST_F(TwoInstances, mapTheirOwnClouds) {
  feedBoth();
  expectFrames(a_.reports(), "lidar_a");
  expectFrames(b_.reports(), "lidar_b");
  ASSERT_TRUE(a_.save(folder_ / "a"));
  ASSERT_TRUE(a_.reset());  // is none of b's business
  ASSERT_TRUE(b_.save(folder_ / "b"));
  mapOfflineA();
  mapOfflineB();
  expectSameRun(folder_ / "a", folder_ / "offline_a");
  expectSameRun(folder_ / "b", folder_ / "offline_b");
  const std::set<FrameTree::Joint> expected = {
      {"map_a", "lidar_a"}, {"map_b", "base_b"}, {"base_b", "lidar_b"}};
  waitFor([&] { return tree_.joints().size() >= expected.size(); });
  EXPECT_EQ(tree_.joints(), expected);
}

bool isShared(const std::string& topic) {
  constexpr std::array<const char*, 5> kShared = {"/tf", "/tf_static", "/diagnostics", "/clock",
                                                  "/rosout"};
  return std::find(kShared.begin(), kShared.end(), topic) != kShared.end();
}

/// Of nodes in the namespace, all names are in it too.
void expectInside(const std::string& space, const Users& users) {
  for (const auto& [name, nodes] : users) {
    const bool inside = name.compare(0, space.size() + 1, space + "/") == 0;
    for (const std::string& node : nodes) {
      if (node.compare(0, space.size() + 1, space + "/") != 0) continue;
      EXPECT_TRUE(inside || isShared(name) || name == "/points_" + space.substr(1))
          << node << " uses " << name;
    }
  }
}

TEST_F(TwoInstances, shareNoNames) {
  ASSERT_TRUE(a_.connect("lidar_a"));
  ASSERT_TRUE(b_.connect("lidar_b"));
  const Graph graph = readGraph();
  for (const char* space : {"/a", "/b"}) {
    ASSERT_EQ(graph.services.count(std::string(space) + "/save_map"), 1U);
    expectInside(space, graph.publishers);
    expectInside(space, graph.subscribers);
    expectInside(space, graph.services);
  }
}

TEST_F(TwoInstances, keepTheirParametersToThemselves) {
  const std::regex usual(
      "/(a|b)/(manager|voxelizer|edge_extractor|mapper)/.+|/two_instances.*|/roslaunch/.*|"
      "/ros(distro|version)|/run_id");
  std::vector<std::string> names;
  ASSERT_TRUE(ros::param::getParamNames(names));
  for (const std::string& name : names) EXPECT_TRUE(std::regex_match(name, usual)) << name;
  EXPECT_EQ(ros::param::param<std::string>("/a/mapper/map_frame", ""), "map_a");
  EXPECT_EQ(ros::param::param<std::string>("/b/mapper/map_frame", ""), "map_b");
}

}  // namespace
}  // namespace edgevox::test

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "two_instances_test");
  const ros::NodeHandle connected;
  return RUN_ALL_TESTS();
}
