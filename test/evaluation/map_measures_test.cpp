// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/map_measures.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "edgevox/io/map_file.hpp"
#include "edgevox/mapping/pipeline.hpp"
#include "table_rows.hpp"

namespace edgevox {
namespace {

using test::number;
using test::Row;
using test::rowsOf;

Recording walk() {
  RecordingOptions options;
  options.input = "building:32";
  options.first = 15;
  options.every = 2;
  options.most = 20;
  return makeRecording(options);
}

MapMeasureOptions smallOptions() {
  MapMeasureOptions options;
  options.anchors = {1, 8};
  options.capture_scans = 4;
  options.capture_trials = 3;
  return options;
}

class MapMeasuresTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    rows_ = rowsOf(measureMaps(walk(), smallOptions(), [](const std::string&) {}));
    ASSERT_EQ(5U, rows_.size());
  }

  static std::vector<Row> rows_;  // all, then sparse and random of 1 and of 8 anchors
};
std::vector<Row> MapMeasuresTest::rows_;

TEST_F(MapMeasuresTest, RowsAreOfTheirMaps) {
  const std::vector<std::string> maps = {"all", "sparse", "random", "sparse", "random"};
  for (size_t i = 0; i < maps.size(); ++i) EXPECT_EQ(maps[i], rows_[i].at("map"));
  EXPECT_DOUBLE_EQ(1.0, number(rows_[0], "smaller"));
  EXPECT_DOUBLE_EQ(1.0, number(rows_[0], "rpe_ratio"));
  EXPECT_GT(number(rows_[1], "smaller"), number(rows_[3], "smaller"));
  EXPECT_GT(number(rows_[3], "smaller"), 1.5);
  for (const size_t sparse : {1U, 3U}) {
    const double bytes = number(rows_[sparse], "map_mb");
    EXPECT_NEAR(bytes, number(rows_[sparse + 1], "map_mb"), 0.15 * bytes);
  }
}

TEST_F(MapMeasuresTest, SizeIsThatOfAMapOfThePipeline) {
  const Recording recording = walk();
  Pipeline pipeline(smallOptions().config);  // 8 anchors
  for (const RecordedScan& scan : recording.scans) pipeline.process(scan.view);
  pipeline.mapper().finishLabels();
  const Config& config = pipeline.config();
  const std::string file = mapFileBytes(MapContent::kCompact, pipeline.mapper(), config, "map");
  EXPECT_NEAR(static_cast<double>(file.size()), 1e6 * number(rows_[3], "map_mb"), 1.0);
}

TEST_F(MapMeasuresTest, ErrorsAreThoseOfAWalkThatIsTracked) {
  for (const Row& row : rows_) {
    EXPECT_EQ(0.0, number(row, "lost"));
    EXPECT_GT(number(row, "rpe_mm"), 0.1);
    EXPECT_LT(number(row, "rpe_mm"), 20.0);
    EXPECT_LT(number(row, "ape_cm"), 3.0);
  }
}

TEST_F(MapMeasuresTest, CaptureFailsFromFarAway) {
  EXPECT_GE(number(rows_[0], "captured"), 0.7);
  MapMeasureOptions far = smallOptions();
  far.anchors.clear();
  far.capture_distance = 200.0;
  const auto rows = rowsOf(measureMaps(walk(), far, [](const std::string&) {}));
  EXPECT_EQ(0.0, number(rows[0], "captured"));
}

}  // namespace
}  // namespace edgevox
