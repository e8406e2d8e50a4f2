// SPDX-License-Identifier: BSD-3-Clause
// What map convert writes, read by the libraries that it is for.
#include <gtest/gtest.h>
#include <octomap/OcTree.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "edgevox/io/map_file.hpp"
#include "tools/map/floor_plan.hpp"
#include "tools/map_tool_fixture.hpp"

namespace edgevox::test {
namespace {

using Normals = pcl::PointCloud<pcl::PointNormal>;
using Points = pcl::PointCloud<pcl::PointXYZ>;

class MapConvert : public MapToolTest {
 protected:
  void convert(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"convert"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = runMap(arguments);
    ASSERT_EQ(0, outcome.exit_code) << outcome.errors;
    EXPECT_EQ("", outcome.errors);
  }
};

TEST_F(MapConvert, makesACompactMapOfEither) {
  convert({file("full"), file("of_full")});
  EXPECT_TRUE(bytesOf(file("a")) == bytesOf(file("of_full")));
  convert({file("a"), file("of_a")});
  EXPECT_TRUE(bytesOf(file("a")) == bytesOf(file("of_a")));
  convert({file("full"), file("still_full"), "--full"});
  EXPECT_TRUE(bytesOf(file("full")) == bytesOf(file("still_full")));
  convert({file("full"), file("full")});
  EXPECT_TRUE(bytesOf(file("a")) == bytesOf(file("full")));
  expectRefused({"convert", file("a"), file("none"), "--full"}, 1, "no full one can be made");
  EXPECT_FALSE(std::filesystem::exists(file("none")));
}

TEST_F(MapConvert, bringsTheLabelsOfAFullMapUpToDate) {
  Mapper mapper{Config{}};
  for (size_t i = 0; i < 8; ++i) mapper.process(maps().scans[i]);  // labelled at the fifth
  save("full", mapFileBytes(MapContent::kFull, mapper, Config{}, "map"));
  convert({file("full"), file("compact")});
  mapper.finishLabels();
  EXPECT_TRUE(mapFileBytes(MapContent::kCompact, mapper, Config{}, "map") ==
              bytesOf(file("compact")));
}

TEST_F(MapConvert, writesEdgesWithTheirDirections) {
  convert({file("a"), path("edges.ply")});
  convert({file("a"), path("edges.pcd")});
  Normals ply;
  Normals pcd;
  ASSERT_EQ(0, pcl::io::loadPLYFile(path("edges.ply"), ply));
  ASSERT_EQ(0, pcl::io::loadPCDFile(path("edges.pcd"), pcd));
  const MatchMap map = read("a");
  ASSERT_GT(map.edges().size(), 100U);
  for (const Normals& cloud : {ply, pcd}) {
    ASSERT_EQ(map.edges().size(), cloud.size());
    for (size_t i = 0; i < cloud.size(); ++i) {
      ASSERT_EQ(map.edges()[i].centroid, Eigen::Vector3f(cloud[i].getVector3fMap()));
      ASSERT_EQ(map.edges()[i].direction, Eigen::Vector3f(cloud[i].getNormalVector3fMap()));
    }
  }
}

TEST_F(MapConvert, writesTheCentresOfOccupiedVoxels) {
  convert({file("a"), path("occupied.ply"), "--occupied"});
  convert({file("a"), path("occupied.pcd"), "--occupied"});
  Points ply;
  Points pcd;
  ASSERT_EQ(0, pcl::io::loadPLYFile(path("occupied.ply"), ply));
  ASSERT_EQ(0, pcl::io::loadPCDFile(path("occupied.pcd"), pcd));
  for (const Points& cloud : {ply, pcd}) {
    Voxels voxels;
    for (const auto& point : cloud) voxels.push_back(voxelAt(point.getVector3fMap(), 5.0));
    EXPECT_EQ(voxels, sorted(voxels));
    EXPECT_TRUE(sameVoxels(voxelsOf(read("a").hitVoxels()), voxels));
  }
}

TEST_F(MapConvert, octomapReadsTheSameVoxels) {
  convert({file("a"), path("map.bt")});
  octomap::OcTree tree(path("map.bt"));
  EXPECT_DOUBLE_EQ(0.2, tree.getResolution());
  tree.expand();
  Voxels voxels;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    ASSERT_TRUE(tree.isNodeOccupied(*leaf));
    const octomap::point3d centre = leaf.getCoordinate();
    voxels.push_back(voxelAt(Eigen::Vector3f(centre.x(), centre.y(), centre.z()), 5.0));
  }
  EXPECT_TRUE(sameVoxels(voxelsOf(read("a").hitVoxels()), sorted(voxels)));
}

TEST_F(MapConvert, octomapHoldsFullBlocksAndNoFarVoxels) {
  Voxels block;
  for (int i = 0; i < 512; ++i) block.push_back({i % 8, i / 8 % 8, i / 64});
  save("block", block);
  convert({file("block"), path("block.bt")});
  octomap::OcTree tree(path("block.bt"));
  EXPECT_EQ(1U, tree.getNumLeafNodes());  // pruned
  tree.expand();
  EXPECT_EQ(512U, tree.getNumLeafNodes());
  save("far", Voxels{{32767, -32768, 0}});
  convert({file("far"), path("far.bt")});
  save("too_far", Voxels{{32768, 0, 0}});
  expectRefused({"convert", file("too_far"), path("too_far.bt")}, 1, "OctoMap cannot hold");
}

/// What a cell of one voxel should be.
char cellOf(const Voxels& voxels, int32_t x, int32_t y, double from, double to) {
  char cell = kUnknownCell;
  for (const VoxelIndex& v : voxels) {
    const double z = 0.2 * (v.z + 0.5);
    if (v.x != x || v.y != y || z >= to) continue;
    if (z >= from) return kBlocked;
    cell = kFreeCell;
  }
  return cell;
}

TEST_F(MapConvert, mapServerReadsObstaclesAndFloor) {
  convert({file("a"), path("floor.yaml"), "--from", "-0.9", "--to", "0.5"});
  const YAML::Node yaml = YAML::LoadFile(path("floor.yaml"));
  EXPECT_DOUBLE_EQ(0.2, yaml["resolution"].as<double>());
  EXPECT_EQ(0, yaml["negate"].as<int>());
  EXPECT_GT(yaml["occupied_thresh"].as<double>(), yaml["free_thresh"].as<double>());
  EXPECT_LT(yaml["free_thresh"].as<double>(), (255.0 - 205.0) / 255.0);  // else 205 were free
  const std::string bytes = bytesOf(path(yaml["image"].as<std::string>()));
  std::istringstream pgm(bytes);
  std::string magic;
  int32_t width = 0;
  int32_t height = 0;
  int most = 0;
  pgm >> magic >> width >> height >> most;
  ASSERT_EQ("P5", magic);
  ASSERT_EQ(255, most);
  const auto cells = static_cast<size_t>(width) * static_cast<size_t>(height);
  ASSERT_EQ(static_cast<size_t>(pgm.tellg()) + 1 + cells, bytes.size());
  const std::string image = bytes.substr(bytes.size() - cells);

  const Voxels voxels = voxelsOf(read("a").hitVoxels());
  const auto first_x = static_cast<int32_t>(std::lround(yaml["origin"][0].as<double>() / 0.2));
  const auto first_y = static_cast<int32_t>(std::lround(yaml["origin"][1].as<double>() / 0.2));
  size_t differing = 0;
  size_t next = 0;
  for (int32_t y = first_y + height - 1; y >= first_y; --y) {
    for (int32_t x = first_x; x < first_x + width; ++x) {
      if (image[next++] != cellOf(voxels, x, y, -0.9, 0.5)) ++differing;
    }
  }
  EXPECT_EQ(0U, differing);
  for (const char cell : {kBlocked, kFreeCell, kUnknownCell}) {
    EXPECT_NE(std::string::npos, image.find(cell));
  }
}

TEST(FloorPlan, CellsNeedNotBeAsLargeAsVoxels) {
  const auto occupied = gridOf<16>({{0, 0, 0}, {2, 0, 5}, {2, 1, -4}});
  const HeightBand band{0.5, 2.0};
  const std::string o{kBlocked};
  const std::string f{kFreeCell};
  const std::string u{kUnknownCell};
  const FloorPlan same = floorPlanOf(occupied, 0.2, band, 0.2);
  EXPECT_EQ(u + u + f + f + u + o, same.cells);
  const FloorPlan finer = floorPlanOf(occupied, 0.2, band, 0.1);
  EXPECT_EQ(6U, finer.width);
  EXPECT_EQ(4U, finer.height);
  const std::string upper = u + u + u + u + f + f;
  const std::string lower = f + f + u + u + o + o;
  EXPECT_EQ(upper + upper + lower + lower, finer.cells);
  const FloorPlan coarser = floorPlanOf(occupied, 0.2, band, 0.3);  // the voxel at 0.4 lies in one
  EXPECT_EQ(u + f + f + o, coarser.cells);
  EXPECT_EQ("P5\n2 2\n255\n" + coarser.cells, coarser.pgm());
}

TEST_F(MapConvert, refusesWhatIsNoUse) {
  expectRefused({"convert", file("a"), path("a.xyz")}, 2, "must end in");
  expectRefused({"convert", file("a"), path("a.bt"), "--occupied"}, 2, "--occupied says nothing");
  expectRefused({"convert", file("a"), path("a.ply"), "--from", "1"}, 2, "--from says nothing");
  expectRefused({"convert", file("a"), path("a.pgm"), "--from", "1"}, 2, "--from and --to");
  expectRefused({"convert", file("a"), path("a.pgm"), "--from", "-99", "--to", "-98"}, 1,
                "nothing is occupied");
  expectRefused(
      {"convert", file("a"), path("a.pgm"), "--from", "0", "--to", "1", "--resolution", "0"}, 2,
      "--resolution");
  save("wide", Voxels{{-1000000, -1000000, 0}, {1000000, 1000000, 0}});
  expectRefused({"convert", file("wide"), path("a.pgm"), "--from", "0", "--to", "1"}, 1,
                "larger --resolution");
  expectRefused({"convert", file("a"), path("none/a.ply")}, 1, "none/a.ply");
  EXPECT_EQ((std::vector<std::string>{"a.edgevox", "b.edgevox", "full.edgevox", "wide.edgevox"}),
            filesThere());
}

}  // namespace
}  // namespace edgevox::test
