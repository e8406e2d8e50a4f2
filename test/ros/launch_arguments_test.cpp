// SPDX-License-Identifier: BSD-3-Clause
// What mapping.launch makes of its arguments, and what play_bag says of a bag it cannot play.
#include <gtest/gtest.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <rosbag/bag.h>
#include <yaml-cpp/yaml.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "ros/launch_fixture.hpp"
#include "tools/cloud_message.hpp"
#include "tools/simulated_bag.hpp"

namespace edgevox::test {
namespace {

class LaunchArguments : public LaunchTest {
 protected:
  /// What the launch file puts on the parameter server, by full name.
  YAML::Node parametersWith(const Words& arguments) {
    std::filesystem::remove(folder_ / "log.txt");
    Words command = {"roslaunch", "--dump-params", "edgevox", "mapping.launch"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const auto roslaunch = start(command);
    EXPECT_TRUE(roslaunch->waitForEnd(20));
    EXPECT_EQ(roslaunch->exitCode(), 0);
    return YAML::Load(log());
  }

  std::string outputWith(const std::string& argument) {
    return parametersWith({argument})["/edgevox/mapper/output"].as<std::string>("none");
  }

  void expectVoxelSize(const std::string& argument, double expected) {
    const YAML::Node parameters = parametersWith({argument});
    for (const char* node : {"voxelizer", "edge_extractor", "mapper"}) {
      const std::string name = std::string("/edgevox/") + node + "/voxel_size";
      EXPECT_EQ(parameters[name].as<double>(0), expected) << argument << " " << node;
    }
  }
};

TEST_F(LaunchArguments, outputIsRelativeToWhereRoslaunchWasStarted) {
  EXPECT_EQ(outputWith("output:=2024_01"), (folder_ / "2024_01").string());
  EXPECT_EQ(outputWith("output:=/maps/today"), "/maps/today");
  EXPECT_EQ(outputWith("output:=~/maps"), std::string(std::getenv("HOME")) + "/maps");
}

TEST_F(LaunchArguments, configIsAPresetOrAFile) {
  std::ofstream(folder_ / "mine.yaml") << "voxel_size: 0.3\n";
  expectVoxelSize("config:=indoor", 0.1);
  expectVoxelSize("config:=mine.yaml", 0.3);
}

TEST_F(LaunchArguments, namesStayNames) {
  const YAML::Node parameters =
      parametersWith({"map_frame:=1", "odom_frame:=2", "base_frame:=true", "publish_tf:=false"});
  const std::string space = "/edgevox/mapper/";
  EXPECT_EQ(parameters[space + "map_frame"].Tag(), "!") << "not quoted";
  EXPECT_EQ(parameters[space + "odom_frame"].Tag(), "!") << "not quoted";
  EXPECT_EQ(parameters[space + "base_frame"].Tag(), "!") << "not quoted";
  EXPECT_FALSE(parameters[space + "publish_tf"].as<bool>(true));
  EXPECT_FALSE(parameters["/use_sim_time"]) << "is for bags";
}

TEST_F(LaunchArguments, topicAndManagerAreThoseOfTheCaller) {
  const auto command = [&](const Words& arguments) {
    std::filesystem::remove(folder_ / "log.txt");
    Words words = {"roslaunch", "--args", "/edgevox/voxelizer", "edgevox", "mapping.launch"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    const auto roslaunch = start(words);
    EXPECT_TRUE(roslaunch->waitForEnd(20));
    return log();
  };
  const auto expect = [](const std::string& text, const std::string& words) {
    EXPECT_NE(text.find(words), std::string::npos) << text;
  };
  expect(command({}), "edgevox/Voxelizer manager points:=/points");
  expect(command({"points:=velodyne_points", "manager:=velodyne_nodelet_manager"}),
         "edgevox/Voxelizer /velodyne_nodelet_manager points:=/velodyne_points");
  expect(command({"points:=/front/points", "manager:=/front/manager"}),
         "edgevox/Voxelizer /front/manager points:=/front/points");
}

TEST_F(LaunchArguments, aBagHasItsOwnClock) {
  const YAML::Node parameters = parametersWith({"bag:=run.bag"});
  EXPECT_TRUE(parameters["/use_sim_time"].as<bool>(false));
  EXPECT_EQ(parameters["/edgevox/mapper/output"].as<std::string>("none"), "");
}

class PlayBag : public LaunchTest {
 protected:
  int check(const Words& arguments) {
    Words command = {EDGEVOX_SOURCE_DIR "/scripts/play_bag", "--check"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const auto player = start(command);
    EXPECT_TRUE(player->waitForEnd(20));
    return player->exitCode().value_or(-1);
  }

  void expectRefused(const Words& arguments, const std::string& text) {
    EXPECT_EQ(check(arguments), 1);
    EXPECT_TRUE(logged(text)) << text;
  }

  void writeTopics(const Words& topics) const {
    sensor_msgs::PointCloud2 cloud = makeCloud({{5, 0, 0}});
    rosbag::Bag bag(offline_.bag, rosbag::bagmode::Write);
    for (const std::string& topic : topics) bag.write(topic, cloud.header.stamp, cloud);
    writeTransform(bag, "/tf", cloud.header.stamp,
                   transformOf("odom", "lidar", cloud.header.stamp, Pose::Identity()));
  }
};

TEST_F(PlayBag, takesTheOnlyTopicOfClouds) {
  writeTopics({"/lidar/points"});
  EXPECT_EQ(check({"run.bag"}), 0);
  EXPECT_TRUE(logged("1 clouds on /lidar/points"));
}

TEST_F(PlayBag, takesTheTopicThatIsNamed) {
  writeTopics({"/left", "/right"});
  EXPECT_EQ(check({"run.bag", "--topic", "/right"}), 0);
  EXPECT_TRUE(logged("1 clouds on /right"));
  expectRefused({"run.bag", "--topic", "/centre"}, "has no clouds on topic '/centre'; choose");
  expectRefused({"run.bag"},
                "has clouds on 2 topics; choose with points:= (--topic) one of: "
                "/left, /right");
}

TEST_F(PlayBag, saysWhyItCannotPlay) {
  expectRefused({"missing.bag"}, "there is no bag 'missing.bag'");
  std::ofstream(offline_.bag) << "no bag";
  expectRefused({"run.bag"}, "'run.bag' cannot be read as a bag");
  writeTopics({});
  expectRefused({"run.bag"}, "has no topic of type sensor_msgs/PointCloud2");
}

}  // namespace
}  // namespace edgevox::test

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "launch_arguments_test");
  const ros::NodeHandle connected;
  return RUN_ALL_TESTS();
}
