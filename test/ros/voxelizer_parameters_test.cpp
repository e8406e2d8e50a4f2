// SPDX-License-Identifier: BSD-3-Clause
// Right, wrong and unknown parameters of the nodelets, and inputs on which nothing comes.
#include <fstream>
#include <vector>

#include "ros/nodelet_fixture.hpp"
#include "support/temp_folder.hpp"

namespace edgevox::test {
namespace {

using Log = rosgraph_msgs::Log;

class ParametersTest : public NodeletTest {
 protected:
  /// The value must keep the node from loading, with a message of these words and the full name.
  template <typename Value>
  void expectRefused(const std::string& node, const std::string& name, const Value& value,
                     std::vector<std::string> words) {
    setParameter(node, name, value);
    words.push_back(resolved(node + "/" + name));
    const size_t before = countLogged(Log::FATAL, words);
    EXPECT_FALSE(load(node)) << name;
    EXPECT_TRUE(eventually([&] { return countLogged(Log::FATAL, words) > before; })) << name;
    ros::param::del(resolved(node + "/" + name));
  }
};

TEST_F(ParametersTest, OutOfRangeIsRefused) {
  const std::string range = "it must be a number from 0.01 to 10 m";
  expectRefused("voxelizer", "voxel_size", 0.001, {"'voxel_size' is '0.001'", range});
  expectRefused("edge_extractor", "voxel_size", -1, {"'voxel_size' is '-1'", range});
  expectRefused("mapper", "voxel_size", 1000.0, {range});
  expectRefused("voxelizer", "queue_size", 0, {"a whole number from 1 to 1000"});
  expectRefused("mapper", "transform_wait", -0.1, {"a number from 0 to 10 s"});
  setParameter("voxelizer", "voxelizer/max_range", 5.0);
  setParameter("voxelizer", "voxelizer/min_range", 5.0);
  EXPECT_FALSE(load("voxelizer"));
  EXPECT_TRUE(logs(Log::FATAL, {"'voxelizer/min_range' must be less than"}));
}

TEST_F(ParametersTest, OfAnotherTypeIsRefused) {
  expectRefused("voxelizer", "voxel_size", std::string("fine"), {"'voxel_size' is 'fine'"});
  expectRefused("voxelizer", "voxel_size", std::string(), {"'voxel_size' is ''"});
  expectRefused("voxelizer", "voxel_size", true, {"'voxel_size' is 'true'"});
  expectRefused("voxelizer", "queue_size", 1.5, {"a whole number"});
  expectRefused("voxelizer", "voxelizer/max_range", std::vector<double>{1, 2},
                {"is a list", "give one value"});
  expectRefused("edge_extractor", "edges/mode", std::string("best"), {"one of default, paper"});
  expectRefused("mapper", "publish_tf", 1, {"true or false"});
  expectRefused("mapper", "mapper/after_clock_jump", std::string("stop"), {"keep_map, clear_map"});
}

TEST_F(ParametersTest, OfTheMapperThatContradictEachOtherAreRefused) {
  expectRefused("mapper", "map_frame", std::string(), {"it must be a name"});
  setParameter("mapper", "odom_frame", "odom");
  setParameter("mapper", "base_frame", "base_link");
  expectRefused("mapper", "map_frame", std::string("odom"), {"not that of odom_frame"});
  expectRefused("mapper", "map_frame", std::string("base_link"),
                {"not that of odom_frame or base"});
  expectRefused("mapper", "output", std::string("maps/today"), {"'maps/today'", "absolute"});
}

TEST_F(ParametersTest, OfTheLocalizerAreChecked) {
  expectRefused("localizer", "initial_pose", std::string("1,2,3"), {"'1,2,3'", "x,y,z,yaw"});
  expectRefused("localizer", "map_frame", std::string(), {"it must be a name"});
}

TEST_F(ParametersTest, AMapThatCannotBeReadIsRefused) {
  const TempFolder folder;
  const std::string none = (folder / "none.edgevox").string();
  const std::string no_map = (folder / "no_map.edgevox").string();
  std::ofstream(no_map) << "no map";
  for (const char* node : {"voxelizer", "edge_extractor", "mapper", "localizer"}) {
    expectRefused(node, "map_file", std::string("map.edgevox"), {"must be absolute"});
    expectRefused(node, "map_file", 2024, {"'2024'", "must be absolute"});
    expectRefused(node, "map_file", none, {"cannot read the map '" + none + "'"});
    expectRefused(node, "map_file", no_map, {"it is not a map of edgevox"});
  }
}

TEST_F(ParametersTest, ThatAreNotKnownAreAWarning) {
  setParameter("voxelizer", "voxelsize", 0.4);
  setParameter("mapper", "voxelsize", 0.4);
  setParameter("mapper", "matcher/nearby", std::vector<int>{1});
  for (const char* node : {"voxelizer", "mapper"}) {
    EXPECT_TRUE(load(node));
    EXPECT_TRUE(logs(Log::WARN, {resolved(node) + "/voxelsize", "not known", "'voxel_size'"}));
  }
  EXPECT_TRUE(logs(Log::WARN, {resolved("mapper/matcher/nearby"), "not known"}));
}

TEST_F(ParametersTest, OnceRightTheNodeletLoads) {
  setParameter("voxelizer", "voxel_size", "fine");
  EXPECT_FALSE(load("voxelizer"));
  setParameter("voxelizer", "voxel_size", 1);           // a whole number of metres
  setParameter("voxelizer", "diagnostic_period", 1.0);  // of the library
  EXPECT_TRUE(load("voxelizer"));
  EXPECT_TRUE(tells("voxelizer", [](const Status&) { return true; }));
  EXPECT_EQ(0U, countLogged(Log::WARN, {space_}));
}

TEST_F(ParametersTest, SilenceIsAWarningThatNamesTheTopic) {
  const std::vector<std::pair<std::string, std::string>> inputs = {
      {"voxelizer", "points"}, {"edge_extractor", "voxels"}, {"mapper", "voxels"}};
  for (const auto& [node, topic] : inputs) ASSERT_TRUE(load(node));
  for (const auto& [node, topic] : inputs) {
    EXPECT_TRUE(tells(node, Status::WARN, {"nothing on '" + resolved(topic) + "' for 5 s"}));
    const auto statuses = statusesOf(node);
    ASSERT_FALSE(statuses.empty());
    EXPECT_EQ(Status::OK, statuses.front().level) << "after one second";
    EXPECT_EQ(resolved(topic), valueOf(statuses.front(), "topic"));
  }
}

}  // namespace
}  // namespace edgevox::test

int main(int argc, char** argv) { return edgevox::test::runNodeletTests(argc, argv); }
