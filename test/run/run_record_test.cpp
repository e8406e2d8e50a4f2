// SPDX-License-Identifier: BSD-3-Clause
// What is remembered of scans, and what of it goes to timings.csv.
#include "run/run_record.hpp"

#include <gtest/gtest.h>

#include <string>

#include "run/run_files.hpp"

namespace edgevox::test {
namespace {

PipelineResult located(double stamp) {
  PipelineResult result;
  result.scan.status = ScanStatus::kTracked;
  result.scan.stamp = stamp;
  result.points = 5;
  result.scan_voxels = 4;
  result.scan.times.voxelize = 0.001F;
  return result;
}

TEST(RunRecord, LeavesOutTheTimeOfEdgesThatNobodyHasExtracted) {
  RunRecord run;
  run.add(0, located(1), Pose::Identity(), 0.01);
  PipelineResult with_edges = located(2);
  with_edges.edges = EdgeCount{100, 20, 5};
  with_edges.scan.times.extract = 0.002F;
  run.add(1, with_edges, Pose::Identity(), 0.01, 0.02);
  const std::string csv = timingsCsv(run.scans);
  EXPECT_EQ(csv.substr(csv.find('\n') + 1),
            "0,1.000000,tracked,0.0000,5,4,1.000,,0.000,0.000,0.000,10.000,\n"
            "1,2.000000,tracked,0.0000,5,4,1.000,2.000,0.000,0.000,0.000,10.000,20.000\n");
  const MapBuilder map(0.2, {}, {}, 1);
  const std::string summary = summarise(run, &map, {}).json();
  EXPECT_NE(summary.find("\"sparse_share\": 0.05"), std::string::npos) << summary;
  EXPECT_NE(summary.find("\"extract\": 2"), std::string::npos) << "of the one scan that has it";
}

TEST(RunRecord, DropsThePosesOfAMapThatWasBegunAnew) {
  RunRecord run;
  run.add(0, located(1), Pose::Identity(), 0);
  PipelineResult anew = located(2);
  anew.scan.begun_anew = true;
  run.add(1, anew, Pose::Identity(), 0);
  run.add(2, located(3), Pose::Identity(), 0);
  EXPECT_EQ(1U, run.begun_anew);
  EXPECT_EQ(3U, run.scans.size());
  ASSERT_EQ(2U, run.trajectory().size());
  EXPECT_EQ(2.0, run.trajectory().front().stamp);
}

TEST(RunRecord, SaysThatNoScanHadEdges) {
  RunRecord run;
  run.add(0, located(1), Pose::Identity(), 0.01);
  const std::string summary = summarise(run, nullptr, {}).json();
  EXPECT_NE(summary.find("\"sparse_share\": null"), std::string::npos) << summary;
  EXPECT_NE(summary.find("\"extract\": null"), std::string::npos) << summary;
}

TEST(RunRecord, CopyStaysAsItWas) {
  RunRecord run;
  for (int i = 0; i < 100; ++i) run.add(static_cast<uint64_t>(i), located(i), Pose::Identity(), 0);
  const RunRecord copy = run;
  for (int i = 100; i < 200; ++i) {
    run.add(static_cast<uint64_t>(i), located(i), Pose::Identity(), 0);
  }
  EXPECT_EQ(100U, copy.count(ScanStatus::kTracked));
  EXPECT_EQ(200U, run.count(ScanStatus::kTracked));
  ASSERT_EQ(100U, copy.trajectory().size());
  EXPECT_EQ(99.0, copy.trajectory().back().stamp);
}

}  // namespace
}  // namespace edgevox::test
