// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/edge_truth.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace edgevox {
namespace {

constexpr double kSize = 0.1;

/// One crease along x from 0 to 2 m, in eight pieces of which all but the last are seen.
EdgeTruth straightCrease() {
  EdgeTruth truth;
  truth.creases = {{{0, 0, 0}, {2, 0, 0}}};
  for (int i = 0; i < 8; ++i) truth.pieces.push_back({{0.25 * i, 0, 0}, {0.25 * (i + 1), 0, 0}});
  truth.seen = {0, 1, 2, 3, 4, 5, 6};
  return truth;
}

LabelledVoxel voxelOf(const VoxelIndex& index, bool edge) {
  return {index, voxelCentre(index, kSize), 0.0, edge};
}

TEST(EdgeJudge, CountsWithinTwoVoxels) {
  const EdgeTruth truth = straightCrease();
  const EdgeJudge judge(truth, kSize);
  EXPECT_TRUE(judge.isTrue(voxelOf({5, 0, 1}, true)));   // 0.16 m away
  EXPECT_FALSE(judge.isTrue(voxelOf({5, 1, 1}, true)));  // 0.21 m
  EXPECT_FALSE(judge.isTrue(voxelOf({22, 0, 0}, true)));
}

TEST(EdgeJudge, ScoresPrecisionChanceAndCoverage) {
  const EdgeTruth truth = straightCrease();
  LabelledVoxels voxels;
  voxels.voxel_size = kSize;
  voxels.voxels = {voxelOf({1, 0, 0}, true),    // covers the first two pieces
                   voxelOf({18, 0, 0}, true),   // the last two, of which one is seen
                   voxelOf({10, 0, 0}, false),  // near, but no edge
                   voxelOf({5, 1, 1}, true),    // beside it, within three voxels
                   voxelOf({5, 9, 9}, true)};   // wrong
  const TruthScore score = EdgeJudge(truth, kSize).score(voxels, truth.seen);
  EXPECT_DOUBLE_EQ(score.precision(), 2.0 / 4.0);
  EXPECT_DOUBLE_EQ(score.widePrecision(), 3.0 / 4.0);
  EXPECT_DOUBLE_EQ(score.chance(), 3.0 / 5.0);
  EXPECT_EQ(score.covered, 3U);
  EXPECT_DOUBLE_EQ(score.coverage(), 3.0 / 7.0);
  EXPECT_TRUE(std::isnan(TruthScore().precision()));
}

TEST(EdgeTruth, OfASimulatedRecordingIsWhatItsScansCanSee) {
  RecordingOptions options;
  options.input = "corridor:32";
  options.every = 20;
  options.most = 3;
  const Recording recording = makeRecording(options);
  const EdgeTruth truth(recording);
  ASSERT_EQ(truth.seen_by.size(), 3U);
  EXPECT_GT(truth.seen_by[0].size(), 20U);
  EXPECT_GE(truth.seen.size(), truth.seen_by[0].size());
  EXPECT_LT(truth.seen.size(), truth.pieces.size());
  // All seen pieces are near the sensor and near the surface.
  const Eigen::Vector3d sensor = recording.scans[0].T_map_sensor.translation();
  for (const uint32_t piece : truth.seen_by[0]) {
    EXPECT_LE(truth.pieces[piece].distanceTo(sensor), kSightRange);
  }
}

TEST(EdgeJudge, JudgesASampleOfTheFalseEdges) {
  RecordingOptions options;
  options.input = "corridor:16";
  options.most = 1;
  const Recording recording = makeRecording(options);
  LabelledVoxels voxels;
  voxels.voxel_size = kSize;
  EdgeTruth none;  // then every edge is false
  for (int32_t i = 0; i < 40; ++i) voxels.voxels.push_back(voxelOf({i, 0, 0}, i % 2 == 0));
  const FalseEdgeJudge cause(recording.truth->world, recording.truth->sensor, {Pose::Identity()});
  const auto judged = [&](size_t most) {
    const CauseCounts counts =
        EdgeJudge(none, kSize).causes(voxels, cause, most, [](const LabelledVoxel&) {
          return Pose::Identity();
        });
    return std::accumulate(counts.begin(), counts.end(), size_t{0});
  };
  EXPECT_EQ(judged(7), 7U);
  EXPECT_EQ(judged(100), 20U);
}

}  // namespace
}  // namespace edgevox
