// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/edge_measures.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "edgevox/edges/edge_extractor.hpp"
#include "edgevox/statistics.hpp"
#include "evaluation/edge_detectors.hpp"
#include "support/sweeps.hpp"
#include "table_rows.hpp"

namespace edgevox {
namespace {

using test::number;
using test::Row;

std::map<std::string, Row> rowsByMethod(const Table& table) {
  std::map<std::string, Row> rows;
  for (const Row& row : test::rowsOf(table)) rows[row.at("method")] = row;
  return rows;
}

Recording standingStill() {
  RecordingOptions options;
  options.input = "building:32";
  options.every = 2;
  options.most = 5;
  return makeRecording(options);
}

/// The sensor stands still in a room in which somebody walks.
Recording walkerInARoom() {
  sim::Mover walker;
  sim::addBox(walker.parts, {}, {-0.15, -0.25, 0.0}, {0.15, 0.25, 1.75}, 0.5);
  walker.line = {{-2.0, -1.5, -1.4}, {2.0, -1.5, -1.4}};
  walker.speed = 1.0;
  const sim::Trajectory path({{{0, 0, 0}}, {{1, 0, 0}}}, sim::Gait{});
  Recording recording;
  recording.truth.emplace(
      SimulatedTruth{test::furnishedRoom(), {walker}, path, sim::makeSensor("32")});
  const SimulatedTruth& truth = *recording.truth;
  for (int sweep = 0; sweep < 10; ++sweep) {
    recording.scans.push_back(recordedScan(
        sim::simulateSweep(truth.world, truth.path, truth.sensor, sweep, 1, truth.movers)));
    recording.scans.back().T_map_sensor = path.poseAt(recording.scans.back().view.stamp);
  }
  return recording;
}

EdgeMeasureOptions smallOptions() {
  EdgeMeasureOptions options;
  options.voxel_sizes = {0.2};
  options.pair_step = 2;
  return options;
}

Table measure(const Recording& recording) {
  return measureEdges(recording, smallOptions(), [](const std::string&) {});
}

class EdgeMeasuresTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { rows_ = rowsByMethod(measure(standingStill())); }

  static std::map<std::string, Row> rows_;
};
std::map<std::string, Row> EdgeMeasuresTest::rows_;

TEST_F(EdgeMeasuresTest, AgreeWithTheExtractorItself) {
  Voxelizer voxelizer({}, 0.2);
  EdgeExtractor extractor({}, 1);
  std::vector<double> occupied;
  std::vector<double> edges;
  std::vector<double> ratios;
  const Recording recording = standingStill();
  for (const RecordedScan& recorded : recording.scans) {
    VoxelScan scan = voxelizer.voxelize(recorded.view);
    const EdgeCount count = extractor.extract(scan);
    occupied.push_back(static_cast<double>(count.occupied));
    edges.push_back(static_cast<double>(count.edges));
    ratios.push_back(occupied.back() / edges.back());
  }
  const Row& row = rows_.at("scan with support");
  EXPECT_NEAR(number(row, "occupied"), mean(occupied), 0.1);
  EXPECT_NEAR(number(row, "kept"), mean(edges), 0.1);
  EXPECT_NEAR(number(row, "compression_mean"), mean(ratios), 1e-4);
  EXPECT_NEAR(number(row, "compression_all"), mean(occupied) / mean(edges), 1e-4);
}

TEST_F(EdgeMeasuresTest, TellTheExtractorsApart) {
  ASSERT_EQ(rows_.size(), 10U);
  const Row& paper = rows_.at("scan as published");
  const Row& plain = rows_.at("scan without support");
  const Row& supported = rows_.at("scan with support");
  const Row& window = rows_.at("scan in a window");
  const Row& map = rows_.at("map");
  // The sensor stands still: what is real is found again.
  EXPECT_GT(number(supported, "again_edges"), 0.8);
  EXPECT_GT(number(supported, "above_chance"), 0.5);
  EXPECT_GT(number(supported, "precision"), number(plain, "precision") + 0.05);
  EXPECT_GT(number(plain, "precision"), number(paper, "precision"));
  EXPECT_GT(number(paper, "precision"), number(paper, "chance"));
  EXPECT_GT(number(supported, "map_precision"), number(plain, "map_precision") + 0.05);
  EXPECT_LE(number(supported, "map_recall"), number(plain, "map_recall"));  // a subset
  EXPECT_GT(number(supported, "map_recall"), 0.9);
  EXPECT_GT(number(window, "precision"), number(supported, "precision"));
  EXPECT_EQ("", window.at("above_chance"));  // windows two scans apart share most
  EXPECT_EQ("", window.at("false_gap"));     // of more scans than one
  EXPECT_GT(number(map, "coverage"), 0.5);
  EXPECT_GT(number(map, "compression_all"), 1.5);
  // Floor and walls on the borders of voxels are two voxels thick.
  const Row& turned = rows_.at("map in a turned grid");
  EXPECT_LT(number(turned, "occupied"), 0.9 * number(map, "occupied"));
  EXPECT_GT(number(turned, "coverage"), 0.5);
  for (const Row* row : {&paper, &plain, &supported, &map, &turned}) {
    EXPECT_NEAR(number(*row, "false_rim") + number(*row, "false_jump") + number(*row, "false_gap") +
                    number(*row, "false_other"),
                1.0, 1e-4);
    EXPECT_GT(number(*row, "ms"), 0.0);
  }
  const double octree = number(rows_.at("octree of a scan"), "compression_all");
  EXPECT_NEAR(octree, 1.0, 0.3);  // the same leaf, in another place
  EXPECT_GT(number(rows_.at("merged octree of a scan"), "compression_all"), octree);
}

TEST_F(EdgeMeasuresTest, CountGhostsWhereSomethingMoves) {
  const Recording recording = walkerInARoom();
  const Table table = measure(recording);
  const auto rows = rowsByMethod(table);
  for (const char* map : {"map", "map in a turned grid"}) {
    const Row& row = rows.at(map);
    EXPECT_GT(number(row, "ghosts"), 10.0);
    EXPECT_NEAR(number(row, "ghost_share"), number(row, "ghosts") / number(row, "occupied"), 1e-5);
    EXPECT_GT(number(row, "false_moved"), 0.0);
    EXPECT_EQ(rows_.at(map).at("ghosts"), "");
    EXPECT_EQ(rows_.at(map).at("false_moved"), "");
  }
  const std::string text = edgesMarkdown(recording, smallOptions(), table);
  EXPECT_NE(text.find("## Ghosts"), std::string::npos);
  EXPECT_NE(text.find("| moved object |"), std::string::npos);
}

/// Ten scans of 16 lines tell wall corners and doors from the gaps between the lines.
TEST(SparseLidar, EdgesInAWindowAreTrueOnes) {
  for (const char* world : {"building:16", "corridor:16"}) {
    RecordingOptions input;
    input.input = world;
    input.first = 60;
    input.most = 20;
    EdgeMeasureOptions options = smallOptions();
    options.pair_step = 10;
    const auto rows =
        rowsByMethod(measureEdges(makeRecording(input), options, [](const std::string&) {}));
    const Row& window = rows.at("scan in a window");
    const Row& alone = rows.at("scan with support");
    for (const char* figure : {"precision", "coverage"}) {
      RecordProperty(std::string(figure) + "_" + world, window.at(figure));
    }
    EXPECT_GT(number(window, "precision"), number(alone, "precision") + 0.05) << world;
    EXPECT_GT(number(window, "precision"), 0.9) << world;
    EXPECT_GT(number(window, "coverage"), number(alone, "coverage") - 0.1) << world;
    EXPECT_GT(number(window, "above_chance"), number(alone, "above_chance")) << world;
  }
}

TEST_F(EdgeMeasuresTest, OtherDetectorsMarkAsManyEdges) {
  EdgeMeasureOptions options = smallOptions();
  options.detectors = true;
  const Recording recording = standingStill();
  const Table table = measureEdges(recording, options, [](const std::string&) {});
  const auto rows = rowsByMethod(table);
  ASSERT_EQ(rows.size(), 15U);
  const Row& supported = rows.at("scan with support");
  for (const EdgeDetector& detector : kEdgeDetectors) {
    const Row& row = rows.at(detector.name);
    EXPECT_EQ(row.at("kept"), supported.at("kept")) << detector.name;
    EXPECT_GT(number(row, "again_edges"), 0.5) << detector.name;
    EXPECT_GT(number(row, "coverage"), 0.0) << detector.name;
    EXPECT_EQ(row.at("ms"), "") << detector.name;
  }
  EXPECT_NE(edgesMarkdown(recording, options, table).find("Harris 3D"), std::string::npos);
}

TEST_F(EdgeMeasuresTest, WithoutTruthItsColumnsStayEmpty) {
  Recording recording = standingStill();
  recording.truth.reset();
  const Table table = measure(recording);
  const auto rows = rowsByMethod(table);
  EXPECT_EQ(rows.at("map").at("precision"), "");
  EXPECT_NE(rows.at("scan with support").at("above_chance"), "");
  const std::string text = edgesMarkdown(recording, smallOptions(), table);
  EXPECT_NE(text.find("## Repeatability"), std::string::npos);
  EXPECT_EQ(text.find("## Truth"), std::string::npos);
  EXPECT_EQ(text.find("## Ghosts"), std::string::npos);
}

}  // namespace
}  // namespace edgevox
