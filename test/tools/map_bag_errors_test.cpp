// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <std_msgs/String.h>

#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "edgevox/io/atomic_file.hpp"
#include "edgevox/io/trajectory_io.hpp"
#include "tools/bag_reader.hpp"
#include "tools/map_bag_fixture.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;
using sensor_msgs::PointCloud2;
using test::MapBagTest;
using test::simulatedRun;

TEST_F(MapBagTest, cloudsWithoutMountingAreNotMapped) {
  writeBag(simulatedRun().clouds);
  options_.frames.base = "base_link";
  expectError<BagError>({"none of the 12 clouds", "no_mounting 12"});
  EXPECT_TRUE(logged("from frame 'lidar' to 'base_link'"));
}

TEST_F(MapBagTest, missingBag) { expectError<BagError>({"there is no bag", options_.bag}); }

TEST_F(MapBagTest, notABag) {
  for (const char* text : {"", "#ROSBAG V2.0\n", "neither this\nnor that\n"}) {
    std::ofstream(options_.bag) << text;
    expectError<BagError>({options_.bag, "cannot be read as a bag"});
  }
  options_.bag = folder_.path().string();
  expectError<BagError>({options_.bag});
}

TEST_F(MapBagTest, bagCutShort) {
  writeBag(simulatedRun().clouds);
  fs::resize_file(options_.bag, fs::file_size(options_.bag) / 2);
  expectError<BagError>({options_.bag});
}

TEST_F(MapBagTest, damagedBag) {
  writeBag(simulatedRun().clouds);
  std::fstream file(options_.bag, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(fs::file_size(options_.bag) / 2));
  file << std::string(200000, '\x5a');
  file.close();
  try {
    run();
  } catch (const BagError& error) {
    EXPECT_NE(std::string(error.what()).find(options_.bag), std::string::npos) << error.what();
  }
}

TEST_F(MapBagTest, noCloudTopic) {
  {
    rosbag::Bag bag(options_.bag, rosbag::bagmode::Write);
    bag.write("/chatter", ros::Time(1), std_msgs::String());
  }
  expectError<BagError>({options_.bag, "no topic of type sensor_msgs/PointCloud2"});
}

TEST_F(MapBagTest, severalCloudTopics) {
  const std::vector<PointCloud2> few(simulatedRun().clouds.begin(),
                                     simulatedRun().clouds.begin() + 2);
  {
    rosbag::Bag bag(options_.bag, rosbag::bagmode::Write);
    test::writeClouds(bag, "/front/points", few);
    test::writeClouds(bag, "/rear/points", few);
  }
  expectError<BagError>({"clouds on 2 topics", "--topic", "/front/points, /rear/points"});
  options_.topic = "/side/points";
  expectError<BagError>({"'/side/points'", "/front/points, /rear/points"});
  options_.topic = "/rear/points";
  EXPECT_EQ(run()["scans"].as<int>(), 2);
}

TEST_F(MapBagTest, noUsableCloud) {
  std::vector<PointCloud2> clouds(simulatedRun().clouds.begin(), simulatedRun().clouds.begin() + 3);
  for (PointCloud2& cloud : clouds) cloud.is_bigendian = 1;
  writeBag(clouds);
  expectError<BagError>({"none of the 3 clouds on topic '/points'", "big_endian 3"});
  options_.skipped = {{0, 2}};
  expectError<BagError>({"--skip"});
}

TEST_F(MapBagTest, outputThatCannotBeWritten) {
  writeBag({simulatedRun().clouds.front()});
  std::ofstream(folder_ / "file") << "in the way";
  options_.output = folder_ / "file" / "out";
  expectError<FileError>({options_.output.string(), "another output folder"});
}

std::map<std::string, std::string> contentsOf(const fs::path& folder) {
  std::map<std::string, std::string> contents;
  for (const auto& entry : fs::directory_iterator(folder)) {
    contents[entry.path().filename().string()] = test::contentOf(entry.path());
  }
  return contents;
}

TEST_F(MapBagTest, badReference) {
  writeBag(simulatedRun().clouds);
  options_.reference = (folder_ / "none.tum").string();
  expectError<FileError>({"none.tum"});
  std::ofstream(folder_ / "none.tum") << "1 2 3\n";
  expectError<TrajectoryError>({"none.tum, line 1"});
  std::ofstream(folder_ / "none.tum") << "1 0 0 0 0 0 0 1\n";
  EXPECT_EQ(run()["tracked"].as<int>(), 12);
  EXPECT_NE(loss_.find("without errors: only 0 of 12 poses"), std::string::npos) << loss_;
  EXPECT_TRUE(fs::exists(options_.output / "trajectory.tum"));
}

/// Of 20 points each.
TEST_F(MapBagTest, aRunWithoutAPoseLeavesTheMapOfTheOneBefore) {
  writeBag(simulatedRun().clouds);
  run();
  const auto before = contentsOf(options_.output);
  std::vector<sensor_msgs::PointCloud2> clouds = simulatedRun().clouds;
  for (sensor_msgs::PointCloud2& cloud : clouds) {
    cloud.width = 20;
    cloud.row_step = cloud.width * cloud.point_step;
    cloud.data.resize(cloud.row_step);
  }
  writeBag(clouds);
  expectError<BagError>({"none of the 12 clouds", "too_few 12"});
  EXPECT_EQ(contentsOf(options_.output), before);
}

TEST_F(MapBagTest, mostlyStaleCloudsAreToldWithAdvice) {
  std::vector<sensor_msgs::PointCloud2> clouds = simulatedRun().clouds;
  for (sensor_msgs::PointCloud2& cloud : clouds) cloud.header.stamp.nsec = 0;
  writeBag(clouds);
  const int located = run()["tracked"].as<int>();
  EXPECT_LE(located, 2);
  EXPECT_TRUE(logged("is stale: ")) << log_.str();
  EXPECT_NE(warning_.find("stamps stand still"), std::string::npos) << warning_;
  EXPECT_NE(warning_.find("of 12 clouds were located"), std::string::npos) << warning_;
}

TEST_F(MapBagTest, aRunThatFailsLeavesTheResultsOfTheOneBefore) {
  writeBag({simulatedRun().clouds.front()});
  run();
  const auto before = contentsOf(options_.output);
  EXPECT_EQ(before.size(), 8U);
  options_.settings = {"voxel_size=0.4"};
  options_.frames.base = "base_link";
  expectError<BagError>({"no_mounting 1"});
  options_.topic = "/none";
  expectError<BagError>({"/none"});
  EXPECT_EQ(contentsOf(options_.output), before);
}

TEST_F(MapBagTest, badConfiguration) {
  writeBag({simulatedRun().clouds.front()});
  options_.settings = {"voxel_size=-1"};
  expectError<ConfigError>({"'voxel_size' is '-1'"});
  options_.settings.clear();
  options_.config = "nowhere";
  expectError<ConfigError>({"no preset 'nowhere'"});
  EXPECT_FALSE(fs::exists(options_.output));
}

}  // namespace
}  // namespace edgevox
