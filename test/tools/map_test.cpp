// SPDX-License-Identifier: BSD-3-Clause
// The tool map, its arguments and what it tells, compares, joins and draws.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "edgevox/io/map_file.hpp"
#include "edgevox/mapping/localizer.hpp"
#include "tools/map_tool_fixture.hpp"

namespace edgevox::test {
namespace {

using MapTool = MapToolTest;

TEST_F(MapTool, tellsWhatAMapHolds) {
  Config config;
  config.map.anchors = 9;
  save("other", mapFileBytes(maps().a.map().completeMap(), config, "world", 22));
  const Outcome outcome = runMap({"info", file("other"), "--json"});
  ASSERT_EQ(0, outcome.exit_code) << outcome.errors;
  const YAML::Node told = YAML::Load(outcome.output);
  const MapBuilder& map = maps().a.map();
  EXPECT_EQ("compact", told["content"].as<std::string>());
  EXPECT_EQ(2, told["version"].as<int>());
  EXPECT_EQ("world", told["frame"].as<std::string>());
  EXPECT_EQ(22, told["scans"].as<int>());
  EXPECT_EQ(map.edgeVoxels().voxelCount(), told["edges"].as<size_t>());
  EXPECT_EQ(map.hitVoxels().voxelCount(), told["levels"]["0"]["occupied"].as<size_t>());
  EXPECT_EQ(static_cast<size_t>(map.levels()), told["levels"].size());
  for (int l = 1; l < map.levels(); ++l) {
    const YAML::Node level = told["levels"][std::to_string(l)];
    EXPECT_EQ(map.matchMap().occupied(l).voxelCount(), level["occupied"].as<size_t>());
    EXPECT_DOUBLE_EQ(0.2 * (1 << l), level["voxel_m"].as<double>());
    ASSERT_EQ(l == 1, level["surfaces"].IsDefined());
    if (l == 1) {
      EXPECT_EQ(map.matchMap().surfaces().selectedCount(), level["surfaces"].as<size_t>());
    }
    const bool has_planes = l >= MatchMap::kFinestPlanes && l <= MatchMap::kCoarsestPlanes;
    ASSERT_EQ(has_planes, level["planes"].IsDefined());
    if (has_planes) EXPECT_EQ(map.matchMap().planes(l).planeCount(), level["planes"].as<size_t>());
  }
  EXPECT_EQ(bytesOf(file("other")).size(), told["bytes"].as<size_t>());
  EXPECT_EQ(1U, told["parameters"].size());
  EXPECT_EQ("9", told["parameters"]["map/anchors"].as<std::string>());
}

TEST_F(MapTool, tellsTheExtentOfAMap) {
  save("few", Voxels{{-10, 0, 3}, {4, 20, 5}});
  const YAML::Node extent = YAML::Load(runMap({"info", file("few"), "--json"}).output)["extent_m"];
  EXPECT_NEAR(-2.0, extent["x_from"].as<double>(), 1e-9);
  EXPECT_NEAR(1.0, extent["x_to"].as<double>(), 1e-9);
  EXPECT_NEAR(0.0, extent["y_from"].as<double>(), 1e-9);
  EXPECT_NEAR(4.2, extent["y_to"].as<double>(), 1e-9);
  EXPECT_NEAR(0.6, extent["z_from"].as<double>(), 1e-9);
  EXPECT_NEAR(1.2, extent["z_to"].as<double>(), 1e-9);
  const Outcome table = runMap({"info", file("full")});
  EXPECT_NE(std::string::npos, table.output.find("\"full\"")) << table.output;
  save("empty", Voxels{});
  EXPECT_EQ(0, runMap({"info", file("empty")}).exit_code);
}

TEST_F(MapTool, countsWhatDiffersWithATolerance) {
  save("before", Voxels{{0, 0, 0}, {5, 0, 0}});
  save("after", Voxels{{1, 0, 0}, {9, 0, 0}});
  const auto counts = [&](const std::string& within, const std::string& name) {
    const Outcome outcome =
        runMap({"diff", file("before"), file("after"), "--within", within, "--json"});
    EXPECT_EQ(0, outcome.exit_code) << outcome.errors;
    return YAML::Load(outcome.output)["occupied"][name].as<int>();
  };
  EXPECT_EQ(2, counts("0", "only_in_a"));
  EXPECT_EQ(2, counts("0", "only_in_b"));
  EXPECT_EQ(1, counts("1", "only_in_a"));
  EXPECT_EQ(1, counts("1", "only_in_b"));
  EXPECT_EQ(1, counts("1", "in_both"));
  EXPECT_EQ(0, counts("4", "only_in_a"));
  EXPECT_EQ(0, counts("4", "only_in_b"));

  ASSERT_EQ(0, runMap({"diff", file("before"), file("after"), "-o", path("changes")}).exit_code);
  const auto lastPoint = [&](const std::string& name) {
    const std::string ply = bytesOf(folder_ / "changes" / name);
    EXPECT_NE(std::string::npos, ply.find("element vertex 1\n"));
    Eigen::Vector3f point;
    std::copy_n(ply.end() - sizeof point, sizeof point, reinterpret_cast<char*>(point.data()));
    return point;
  };
  EXPECT_TRUE(lastPoint("added.ply").isApprox(Eigen::Vector3f(1.9F, 0.1F, 0.1F)));
  EXPECT_TRUE(lastPoint("removed.ply").isApprox(Eigen::Vector3f(1.1F, 0.1F, 0.1F)));
}

TEST_F(MapTool, findsNoDifferenceBetweenAMapAndItself) {
  const Outcome outcome = runMap({"diff", file("a"), file("full"), "--within", "0", "--json"});
  const YAML::Node told = YAML::Load(outcome.output);
  for (const char* kind : {"occupied", "edges"}) {
    EXPECT_EQ(0, told[kind]["only_in_a"].as<int>());
    EXPECT_EQ(0, told[kind]["only_in_b"].as<int>());
    EXPECT_EQ(told[kind]["a"].as<int>(), told[kind]["in_both"].as<int>());
    EXPECT_GT(told[kind]["a"].as<int>(), 100);
  }
}

TEST_F(MapTool, mergesMapsInWhichTheScansOfBothAreLocated) {
  for (const char* first : {"a", "full"}) {
    const Outcome outcome = runMap({"merge", file(first), file("b"), "-o", file("both")});
    ASSERT_EQ(0, outcome.exit_code) << outcome.errors;
    const MapFile merged = MapFile::read(file("both"));
    EXPECT_EQ(MapContent::kCompact, merged.head().content);
    EXPECT_EQ(maps().a.map().scans() + maps().b.map().scans(), merged.head().scans);
    Voxels expected = voxelsOf(read("a").hitVoxels());
    for (const VoxelIndex& v : voxelsOf(read("b").hitVoxels())) expected.push_back(v);
    EXPECT_TRUE(sameVoxels(sorted(expected), voxelsOf(merged.matchMap().hitVoxels())));
    Localizer localizer(merged.config(), merged.matchMap());
    for (size_t i = 0; i < maps().scans.size(); ++i) {
      const ScanResult result = localizer.process(maps().scans[i]);
      ASSERT_TRUE(result.located()) << i;
      EXPECT_LT(differenceOf(maps().poses[i], result.T_map_sensor).metres, 0.1) << i;
    }
  }
}

TEST_F(MapTool, refusesToMergeWhatDoesNotFit) {
  const MatchMap map = maps().a.map().completeMap();
  Config config;
  config.map.min_hits = 3;
  save("other", mapFileBytes(map, config, "map", 1));
  save("elsewhere", mapFileBytes(map, Config{}, "hall", 1));
  expectRefused({"merge", file("a"), file("other"), "-o", file("c")}, 2, "map/min_hits, 2 and 3");
  expectRefused({"merge", file("a"), file("elsewhere"), "-o", file("c")}, 2, "'map' and 'hall'");
  expectRefused({"diff", file("a"), file("elsewhere")}, 2, "'map' and 'hall'");
  EXPECT_FALSE(std::filesystem::exists(file("c")));
}

TEST_F(MapTool, drawsAPictureOfTheWidthAskedFor) {
  const auto before = filesThere();
  const Outcome outcome = runMap({"draw", file("a"), "-o", path("a.png"), "--width", "700"});
  ASSERT_EQ(0, outcome.exit_code) << outcome.errors;
  const std::string png = bytesOf(path("a.png"));
  ASSERT_EQ("\x89PNG", png.substr(0, 4));
  const auto byte = [&](size_t at) { return static_cast<unsigned char>(png[at]); };
  EXPECT_EQ(700, byte(18) << 8 | byte(19));
  EXPECT_GT(png.size(), 5000U);
  EXPECT_EQ(before.size() + 1, filesThere().size());
  expectRefused({"draw", file("a"), "-o", path("b.png"), "--from", "900"}, 1,
                "no voxels at these heights");
  EXPECT_EQ(before.size() + 1, filesThere().size());
}

TEST_F(MapTool, damagedMapsGiveASentenceAndNoFile) {
  std::string damaged = bytesOf(file("a"));
  damaged[damaged.size() / 2] ^= 1;
  save("damaged", damaged);
  save("foreign", "ply\nformat ascii 1.0\n");
  const auto before = filesThere();
  const std::vector<std::vector<std::string>> commands = {
      {"info", "?"},
      {"convert", "?", file("c")},
      {"convert", "?", path("c.ply")},
      {"convert", "?", path("c.bt")},
      {"convert", "?", path("c.pgm"), "--from", "0", "--to", "1"},
      {"diff", file("a"), "?", "-o", path("c")},
      {"diff", "?", file("a"), "-o", path("c")},
      {"merge", file("a"), "?", "-o", file("c")},
      {"merge", "?", file("a"), "-o", file("c")},
      {"draw", "?", "-o", path("c.png")}};
  for (auto command : commands) {
    const auto at = std::find(command.begin(), command.end(), "?");
    *at = file("damaged");
    expectRefused(command, 1, "damaged.edgevox': it is damaged");
    *at = file("foreign");
    expectRefused(command, 1, "foreign.edgevox': it is not a map of edgevox");
    *at = file("none");
    expectRefused(command, 1, "none.edgevox'");
  }
  EXPECT_EQ(before, filesThere());
}

TEST_F(MapTool, refusesWhatItDoesNotKnow) {
  expectRefused({"turn"}, 2, "'turn' is not known: info, convert, diff, merge, draw");
  expectRefused({"info"}, 2, "file");
  expectRefused({"info", file("a"), file("b")}, 2, "positional");
  expectRefused({"merge", file("a"), file("b")}, 2, "output");
  expectRefused({"diff", file("a"), file("b"), "--within", "11"}, 2, "at most 10");
  expectRefused({"draw", file("a"), "-o", path("c.png"), "--from", "2", "--to", "1"}, 2, "--from");
  EXPECT_EQ(0, runMap({"--help"}).exit_code);
  for (const char* name : {"info", "convert", "diff", "merge", "draw"}) {
    EXPECT_EQ(0U, runMap({name, "--help"}).output.find(std::string("Usage: map ") + name));
  }
}

}  // namespace
}  // namespace edgevox::test
