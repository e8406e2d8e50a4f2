// SPDX-License-Identifier: BSD-3-Clause
// The three nodelets as processes of their own, as if on three computers.
#include <gtest/gtest.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <sensor_msgs/PointCloud2.h>

#include <set>
#include <string>
#include <vector>

#include "ros/launch_feeder.hpp"
#include "ros/launch_graph.hpp"
#include "ros/launch_run.hpp"
#include "tools/map_bag_fixture.hpp"

namespace edgevox::test {
namespace {

class Standalone : public MapBagTest {};

TEST_F(Standalone, mapsAsOneManagerDoes) {
  const std::vector<sensor_msgs::PointCloud2>& clouds = simulatedRun().clouds;
  Feeder feeder("/edgevox", "/edgevox/points");
  ASSERT_TRUE(feeder.connect("lidar"));
  EXPECT_EQ(readGraph().publishers["/edgevox/voxels"], std::set<std::string>{"/edgevox/voxelizer"});
  EXPECT_EQ(readGraph().publishers["/edgevox/edges"],
            std::set<std::string>{"/edgevox/edge_extractor"});
  for (const auto& cloud : clouds) ASSERT_TRUE(feeder.feed(cloud));
  ASSERT_TRUE(feeder.save(folder_ / "online"));
  writeBag(clouds);
  mapOffline(options_);
  expectSameRun(folder_ / "online", options_.output);
}

}  // namespace
}  // namespace edgevox::test

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "launch_standalone_test");
  const ros::NodeHandle connected;
  return RUN_ALL_TESTS();
}
