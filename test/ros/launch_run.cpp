// SPDX-License-Identifier: BSD-3-Clause
#include "ros/launch_run.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "tools/console.hpp"
#include "tools/map_bag_fixture.hpp"
#include "tools/map_bag_run.hpp"

namespace edgevox::test {

void mapOffline(const MapBagOptions& options) {
  std::ostringstream log;
  Console console(log, false);
  runMapBag(options, console);
}

YAML::Node summaryOf(const std::filesystem::path& folder) {
  return YAML::Load(contentOf(folder / "summary.json"));
}

void expectSameFiles(const std::filesystem::path& online, const std::filesystem::path& offline) {
  for (const char* file : {"trajectory.tum", "map_edges.ply", "map_edges.pcd", "config.yaml"}) {
    const std::string expected = contentOf(offline / file);
    EXPECT_FALSE(expected.empty()) << file;
    EXPECT_TRUE(contentOf(online / file) == expected) << file << " is not the same";
  }
}

void expectSameRun(const std::filesystem::path& online, const std::filesystem::path& offline) {
  expectSameFiles(online, offline);
  YAML::Node ours = summaryOf(online);
  YAML::Node expected = summaryOf(offline);
  EXPECT_EQ(ours["dropped"].as<int>(-1), 0);
  for (const char* name :
       {"scans", "tracked", "fallback", "lost", "stale", "too_few_voxels", "without_odometry",
        "odometry_jumps", "clock_jumps", "begun_anew", "degenerate", "edge_voxels",
        "occupied_voxels", "points", "time_field", "points_bad_time"}) {
    EXPECT_EQ(ours[name].as<std::string>("none"), expected[name].as<std::string>("no such entry"))
        << name;
  }
}

}  // namespace edgevox::test
