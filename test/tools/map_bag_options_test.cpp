// SPDX-License-Identifier: BSD-3-Clause
#include "tools/map_bag_options.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace edgevox {
namespace {

void expectError(const Arguments& arguments, const std::string& words) {
  try {
    parseMapBagOptions(arguments);
    ADD_FAILURE() << "no error; expected " << words;
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

TEST(MapBagOptions, defaults) {
  const auto options = parseMapBagOptions({"run.bag", "--output", "out"});
  ASSERT_TRUE(options);
  EXPECT_EQ(options->bag, "run.bag");
  EXPECT_EQ(options->output, "out");
  EXPECT_EQ(options->topic, "");
  EXPECT_EQ(options->stride, 1U);
  EXPECT_TRUE(options->skipped.empty());
  EXPECT_TRUE(options->settings.empty());
  EXPECT_FALSE(options->write_occupied);
}

TEST(MapBagOptions, allGiven) {
  const auto options = parseMapBagOptions({"run.bag",
                                           "-o",
                                           "out",
                                           "--topic",
                                           "/p",
                                           "--config",
                                           "indoor",
                                           "--reference",
                                           "r.tum",
                                           "--base-frame",
                                           "base",
                                           "--odom-frame",
                                           "odom",
                                           "--stride",
                                           "3",
                                           "--skip",
                                           "2-5",
                                           "--skip",
                                           "9-9",
                                           "--occupied",
                                           "--representation",
                                           "all",
                                           "--threads",
                                           "2",
                                           "--set",
                                           "voxel_size=0.2",
                                           "map/min_hits=1",
                                           "--set",
                                           "edges/mode=paper"});
  ASSERT_TRUE(options);
  EXPECT_EQ(options->topic, "/p");
  EXPECT_EQ(options->reference, "r.tum");
  EXPECT_EQ(options->frames.base, "base");
  EXPECT_EQ(options->frames.odom, "odom");
  EXPECT_TRUE(options->write_occupied);
  const std::vector<std::string> settings = {"map/representation=all", "threads=2",
                                             "voxel_size=0.2", "map/min_hits=1",
                                             "edges/mode=paper"};
  EXPECT_EQ(options->settings, settings);
  std::vector<size_t> used;
  for (size_t i = 0; i < 16; ++i) {
    if (isUsed(i, *options)) used.push_back(i);
  }
  EXPECT_EQ(used, (std::vector<size_t>{0, 6, 12, 15}));
}

TEST(MapBagOptions, tellWhereToLookInAMap) {
  const auto none = parseMapBagOptions({"run.bag", "-o", "out", "--localize", "m.edgevox"});
  EXPECT_FALSE(none->start);
  const auto given = parseMapBagOptions(
      {"run.bag", "-o", "out", "--localize", "m.edgevox", "--start=-1.5,2,0.25,90"});
  ASSERT_TRUE(given->start);
  EXPECT_TRUE(given->start->translation().isApprox(Eigen::Vector3d(-1.5, 2, 0.25)));
  EXPECT_TRUE(given->start->linear().col(0).isApprox(Eigen::Vector3d::UnitY()));
  for (const std::string text : {"1,2,3", "1,2,3,4,5", "1,2,x,4", "1 2 3 4"}) {
    expectError({"run.bag", "-o", "out", "--localize", "m.edgevox", "--start=" + text},
                "x,y,z,yaw");
  }
  expectError({"run.bag", "-o", "out", "--start=1,2,3,4"}, "--localize");
}

TEST(MapBagOptions, settingsOverrideTheFile) {
  MapBagOptions options;
  options.config = "outdoor";
  options.settings = {"voxel_size=0.3"};
  EXPECT_EQ(configOf(options).voxel_size, 0.3);
  options.settings = {"voxelizer/min_range=200"};
  EXPECT_THROW(configOf(options), ConfigError);
}

TEST(MapBagOptions, errors) {
  expectError({}, "BAG");
  expectError({"--output", "out"}, "BAG");
  expectError({"run.bag"}, "--output");
  expectError({"run.bag", "second.bag", "--output", "out"}, "positional");
  expectError({"run.bag", "--output"}, "--output");
  expectError({"run.bag", "--output", "o", "--strid", "2"}, "strid");
  expectError({"run.bag", "--output", "o", "--stride", "0"}, "--stride");
  expectError({"run.bag", "--output", "o", "--stride", "x"}, "'x'");
  expectError({"run.bag", "--output", "o", "--skip", "5"}, "--skip");
  expectError({"run.bag", "--output", "o", "--skip", "5-"}, "--skip");
  expectError({"run.bag", "--output", "o", "--skip", "5-2"}, "5-2");
  expectError({"run.bag", "--output", "o", "--skip", "1-99999999999"}, "--skip");
}

}  // namespace
}  // namespace edgevox
