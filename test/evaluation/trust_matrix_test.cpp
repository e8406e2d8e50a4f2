// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/trust_matrix.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "edgevox/mapping/pipeline.hpp"
#include "evaluation/trust_report.hpp"
#include "table_rows.hpp"

namespace edgevox {
namespace {

using test::number;
using test::rowsOf;

constexpr size_t kScans = 24;

void ignore(const std::string&) {}

TrustRecording corridor(size_t seed) {
  const std::string name = "corridor:16:" + std::to_string(seed);
  return {name, "corridor", "16", seed, simulatedStream(name)};
}

TrustOptions shortOptions() {
  TrustOptions options;
  options.strides = {1, 4};
  options.most = kScans;
  return options;
}

/// `stream` with truths that run away by `step` [m] a scan.
ScanStream drifting(const ScanStream& stream, double step) {
  return [=](size_t most, const VisitScan& visit) {
    double off = 0.0;
    stream(most, [&](const CloudView& cloud, const TruePose& truth) {
      Pose moved = truth(0.0);
      moved.translation().y() += off;
      off += step;
      visit(cloud, [&](double) { return moved; });
    });
  };
}

TEST(TrustMatrix, DoesNotDependOnThreads) {
  const std::vector<TrustRecording> recordings = {corridor(1), corridor(2), corridor(3)};
  TrustOptions options = shortOptions();
  const std::string one = trustTable(recordings, runMatrix(recordings, options, ignore)).csv();
  options.threads = 3;
  EXPECT_EQ(one, trustTable(recordings, runMatrix(recordings, options, ignore)).csv());
}

TEST(TrustMatrix, MapsAsThePipelineDoes) {
  const TrustOptions options = shortOptions();
  const auto cells = runMatrix({corridor(1)}, options, ignore);
  ASSERT_EQ(cells.size(), 2U);
  for (const TrustCell& cell : cells) {
    Pipeline pipeline(options.config);
    TrustTally tally;
    size_t i = 0;
    simulatedStream("corridor:16:1")(kScans, [&](const CloudView& cloud, const auto& truth) {
      if (i++ % cell.stride == 0) tally.add(pipeline.process(cloud).scan, truth(0.0));
    });
    EXPECT_EQ(cell.counts.right, kScans / cell.stride);
    EXPECT_EQ(cell.counts.right_distances, tally.counts().right_distances);
    EXPECT_EQ(cell.counts.statuses, tally.counts().statuses);
  }
}

TEST(TrustMatrix, TellsPosesThatDriftFromTheTruth) {
  TrustRecording recording = corridor(1);
  recording.scans = drifting(recording.scans, 0.1);
  TrustOptions options = shortOptions();
  options.most = 11;
  const auto cells = runMatrix({recording}, options, ignore);
  EXPECT_EQ(cells[0].counts.scans(), 11U);
  EXPECT_NEAR(static_cast<double>(cells[0].counts.wrong), 5.5, 0.6);  // those after 0.5 m
  EXPECT_EQ(cells[1].counts.right, 2U);
  EXPECT_EQ(cells[1].counts.wrong, 1U);
  EXPECT_NEAR(cells[1].counts.farthest, 0.8, 0.05);
}

TEST(TrustMatrix, PassesOnWhatAStreamThrows) {
  TrustRecording recording = corridor(1);
  recording.scans = [](size_t, const VisitScan&) { throw std::runtime_error("damaged"); };
  EXPECT_THROW(runMatrix({corridor(1), recording}, shortOptions(), ignore), std::runtime_error);
}

class TrustReportTest : public ::testing::Test {
 protected:
  TrustReportTest() {
    recordings_ = {corridor(4), corridor(7), {"my.bag", "", "", 0, {}}};
    for (size_t i = 0; i < recordings_.size(); ++i) cells_.push_back({i, 3, {}});
    cells_[0].counts.right = 90;
    cells_[0].counts.lost = 10;
    cells_[1].counts.right = 60;
    cells_[1].counts.wrong = 40;
    cells_[2].counts.right = 25;
    cells_[2].counts.lost = 75;
  }

  std::vector<TrustRecording> recordings_;
  std::vector<TrustCell> cells_;
};

TEST_F(TrustReportTest, MarkdownSumsUpSeeds) {
  const std::string text = trustMarkdown(recordings_, cells_, {});
  EXPECT_NE(std::string::npos, text.find("| corridor | 16 | 3 | 200 | 75.00 | 5.00 | 21.05 |"))
      << text;
  EXPECT_NE(std::string::npos, text.find("| 1 | 2 | 7 |\n")) << text;
  EXPECT_NE(std::string::npos, text.find("| my.bag | 3 | 100 | 25.00 | 75.00 | 0.00 |")) << text;
  EXPECT_NE(std::string::npos, text.find("300 scans in 3 runs: 175 right, 85 lost, 40 wrong"))
      << text;
}

TEST_F(TrustReportTest, TableHasARowACell) {
  const auto rows = rowsOf(trustTable(recordings_, cells_));
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[1].at("recording"), "corridor:16:7");
  EXPECT_EQ(number(rows[1], "seed"), 7.0);
  EXPECT_EQ(number(rows[1], "wrong"), 40.0);
  EXPECT_EQ(number(rows[1], "fallback"), 0.0);
  EXPECT_EQ(rows[2].at("world"), "");
  EXPECT_EQ(number(rows[2], "lost"), 75.0);
}

}  // namespace
}  // namespace edgevox
