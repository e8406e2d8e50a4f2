// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/edges/dense_kernel.hpp"
#include "edgevox/edges/edge_extractor.hpp"
#include "evaluation/paper_data.hpp"
#include "evaluation/paper_report.hpp"
#include "evaluation/paper_run.hpp"

namespace edgevox::test {
namespace {

PaperOptions fewScans() {
  PaperOptions options;
  options.recording.most = 5;
  options.recording.every = 3;
  options.config.voxel_size = 0.1;
  return options;
}

const ScanStream& building() {
  static const ScanStream stream = simulatedStream("building:16");
  return stream;
}

/// Finds each pose, but for a metre along z.
class OneMetreAbove : public PaperMethod {
 public:
  PaperPose align(const PaperScan& scan, const Pose&) override {
    Pose pose = scan.T_map_sensor;
    pose.translation().z() += 1.0;
    return {pose, true};
  }
  void insert(const PaperScan&, const Pose&) override {}
};

class OutOfMemory final : public OneMetreAbove {
 public:
  void insert(const PaperScan&, const Pose&) override {
    blocks_.emplace_back(size_t{200} << 20, 'x');
  }

 private:
  std::vector<std::string> blocks_;
};

class Failing final : public OneMetreAbove {
 public:
  PaperPose align(const PaperScan&, const Pose&) override { throw std::runtime_error("no"); }
};

class Crashing final : public OneMetreAbove {
 public:
  PaperPose align(const PaperScan&, const Pose&) override { std::abort(); }
};

template <typename Method>
PaperRow rowOf(const PaperOptions& options) {
  return runPaperMethod({"it", PaperVoxels::kAll, [] { return std::make_unique<Method>(); }},
                        building(), options);
}

TEST(PaperRun, RecordsTheErrorOfEachScanButTheFirst) {
  const PaperRow row = rowOf<OneMetreAbove>(fewScans());
  EXPECT_EQ(PaperEnd::kDone, row.end);
  ASSERT_EQ(4U, row.scans.size());
  for (size_t i = 0; i < row.scans.size(); ++i) {
    const PaperRecord& scan = row.scans[i];
    EXPECT_EQ(3 * (i + 1), scan.scan);
    EXPECT_NEAR(1.0, scan.metres, 1e-9);
    EXPECT_NEAR(0.0, scan.degrees, 1e-4);
    EXPECT_EQ(1U, scan.located);
    EXPECT_GT(scan.voxels, scan.edges);
    EXPECT_GT(scan.edges, 100U);
    EXPECT_GT(scan.map_voxels, scan.true_voxels);  // the first one is a metre below
    EXPECT_GT(scan.extract, 0.0);
  }
  EXPECT_GT(row.megabytes, 10.0);
}

TEST(PaperRun, EndsWhatExceedsItsLimits) {
  PaperOptions options = fewScans();
  options.seconds = 0.0;
  const PaperRow slow = rowOf<OutOfMemory>(options);
  EXPECT_EQ(PaperEnd::kTime, slow.end);
  EXPECT_LT(slow.scans.size(), 4U);
  options = fewScans();
  options.megabytes = 500;
  const PaperRow large = rowOf<OutOfMemory>(options);
  EXPECT_EQ(PaperEnd::kMemory, large.end);
  EXPECT_LT(large.scans.size(), 4U);
  options.megabytes = 8000;
  EXPECT_EQ(PaperEnd::kDone, rowOf<OutOfMemory>(options).end);
}

TEST(PaperRun, OutlivesAMethodThatFails) {
  EXPECT_EQ(PaperEnd::kFailed, rowOf<Failing>(fewScans()).end);
  EXPECT_EQ(PaperEnd::kFailed, rowOf<Crashing>(fewScans()).end);
}

TEST(PaperMethods, FindScansAndAreTheSameEveryTime) {
  PaperOptions options = fewScans();
  options.recording.most = 3;
  options.error.distance = 0.05;
  options.error.angle = 1.0;
  const std::vector<NamedPaperMethod> methods = paperMethods(options.config, options.error);
  ASSERT_EQ(8U, methods.size());
  for (const NamedPaperMethod& method : methods) {
    const PaperRow row = runPaperMethod(method, building(), options);
    const PaperRow again = runPaperMethod(method, building(), options);
    ASSERT_EQ(2U, row.scans.size()) << method.name;
    ASSERT_EQ(2U, again.scans.size()) << method.name;
    for (size_t i = 0; i < row.scans.size(); ++i) {
      EXPECT_EQ(1U, row.scans[i].located) << method.name;
      EXPECT_LT(row.scans[i].metres, 0.15) << method.name;
      EXPECT_EQ(row.scans[i].metres, again.scans[i].metres) << method.name;
      EXPECT_EQ(row.scans[i].degrees, again.scans[i].degrees) << method.name;
      EXPECT_EQ(row.scans[i].map_voxels, again.scans[i].map_voxels) << method.name;
    }
  }
}

BitGrid<16> plane() {
  BitGrid<16> occupied;
  for (int x = 0; x < 20; ++x) {
    for (int y = 0; y < 20; ++y) occupied.set({x, y, 3});
  }
  return occupied;
}

TEST(PublishedEigenvalues, OfAPlane) {
  const Eigen::Vector3d values = publishedEigenvalues(plane(), {{10, 10, 3}}).at(0);
  EXPECT_NEAR(kernel::kPaperPlane, values[2], 1e-3);
  EXPECT_NEAR(0.0, values[1], 1e-12);
  EXPECT_NEAR(0.0, values[0], 1e-12);
}

TEST(PublishedEigenvalues, TellTheEdgesOfTheExtractor) {
  BitGrid<16> occupied = plane();
  for (int x = 0; x < 20; ++x) {
    for (int z = 3; z < 20; ++z) occupied.set({x, 10, z});
  }
  EdgeConfig config;
  config.mode = EdgeMode::kPaper;
  BitGrid<16> edges;
  EdgeLabeller<16>(config, config.scan, 1).label(occupied, occupied, edges);
  std::vector<VoxelIndex> voxels;
  occupied.forEach([&](const VoxelIndex& v) { voxels.push_back(v); });
  const auto eigenvalues = publishedEigenvalues(occupied, voxels);
  size_t count = 0;
  for (size_t i = 0; i < voxels.size(); ++i) {
    const Eigen::Vector3d& values = eigenvalues[i];
    const bool close = (values.array() - 1.0).abs().minCoeff() < 1e-3;
    if (close) continue;
    EXPECT_EQ(values[0] < 1.0 && values[1] > 1.0, edges.test(voxels[i])) << i;
    count += edges.test(voxels[i]) ? 1 : 0;
  }
  EXPECT_GT(count, 20U);
}

TEST(PaperData, CountsWhatARecordingHolds) {
  const PaperData data = measureData(building(), fewScans());
  EXPECT_EQ(5U, data.scans);
  EXPECT_GT(data.points, data.voxels);
  EXPECT_GT(data.voxels, data.edges);
  EXPECT_GE(data.voxels, data.merged_leaves);
  EXPECT_GT(data.compression, 1.0);
  EXPECT_GE(data.map_voxels, static_cast<size_t>(data.voxels));
  EXPECT_GT(data.map_voxels, data.map_edges);
  EXPECT_GE(data.map_voxels, data.map_merged_leaves);
  EXPECT_GT(data.extent.minCoeff(), 1.0);
  size_t voxels = 0;
  for (const size_t bin : data.ratios) voxels += bin;
  EXPECT_EQ(static_cast<size_t>(std::lround(5 * data.voxels)), voxels);
  ASSERT_FALSE(data.extraction.empty());
  EXPECT_EQ(1, data.extraction.front().threads);
  EXPECT_GT(data.extraction.front().milliseconds, 0.0);
}

TEST(PaperReport, TellsWhatExceedsALimit) {
  PaperRow row;
  row.name = "ICP on edge voxels";
  PaperRecord scan;
  scan.located = 1;
  scan.metres = 0.02;
  row.scans = {scan, scan};
  PaperRow ended = row;
  ended.name = "MROL on all voxels";
  ended.end = PaperEnd::kTime;
  const PaperOptions options = fewScans();
  const std::string text = paperMarkdown("here", PaperData(), {row, ended}, options);
  EXPECT_NE(std::string::npos, text.find("more than 600 s")) << text;
  EXPECT_NE(std::string::npos, text.find("| ICP on edge voxels | 2 | 100.0 |")) << text;
  EXPECT_EQ(4U, paperScans({row, ended}).rows());
  EXPECT_EQ(PaperData::kBins, paperRatios(PaperData()).rows());
}

}  // namespace
}  // namespace edgevox::test
