// SPDX-License-Identifier: BSD-3-Clause
// Whole runs through simulated worlds against the true motion.
#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "edgevox/io/trajectory_evaluation.hpp"
#include "edgevox/mapping/pipeline.hpp"
#include "support/sweeps.hpp"

namespace edgevox::test {
namespace {

struct MappedRun {
  Trajectory trajectory;
  size_t lost = 0;
  size_t voxels = 0;
};

MappedRun runOf(const std::vector<Sweep>& sweeps, size_t count, const Config& config) {
  Pipeline pipeline(config);
  MappedRun run;
  for (size_t i = 0; i < count; ++i) {
    const PipelineResult result = pipeline.process(sweeps[i].view());
    if (result.scan.located()) {
      run.trajectory.push_back({result.scan.stamp, result.scan.T_map_sensor});
    } else {
      ++run.lost;
    }
  }
  run.voxels = pipeline.map().hitVoxels().voxelCount();
  return run;
}

const Walk& building() {
  static const Walk walk = simulateWalk(sim::WorldName::Building, "32", 0, 120);
  return walk;
}

bool sameTrajectory(const Trajectory& a, const Trajectory& b) {
  if (a.size() != b.size()) return false;
  for (size_t i = 0; i < a.size(); ++i) {
    if (a[i].stamp != b[i].stamp || !sameBits(a[i].pose, b[i].pose)) return false;
  }
  return true;
}

Config withRepresentation(Representation representation) {
  Config config;
  config.map.representation = representation;
  return config;
}

class Building : public ::testing::TestWithParam<Representation> {};

TEST_P(Building, TwelveSecondsAreMapped) {
  const MappedRun run =
      runOf(building().sweeps, building().sweeps.size(), withRepresentation(GetParam()));
  EXPECT_EQ(0U, run.lost);
  const TrajectoryErrors errors = evaluate(run.trajectory, building().truth);
  RecordProperty("ape_m", std::to_string(errors.ape_rmse_m));
  RecordProperty("ape_deg", std::to_string(errors.ape_rmse_deg));
  RecordProperty("rpe_median_m", std::to_string(errors.moving.median_m));
  EXPECT_EQ(building().sweeps.size(), errors.poses.size());
  EXPECT_GT(errors.moving.pairs, 80U);
  EXPECT_LT(errors.ape_rmse_m, 0.03);
  EXPECT_LT(errors.ape_rmse_deg, 0.3);
}

INSTANTIATE_TEST_SUITE_P(Representations, Building,
                         ::testing::Values(Representation::kSparse, Representation::kAll));

/// As the preset paper, but in larger voxels.
TEST(Building, IsMappedByEdgesOfScansAlone) {
  Config config;
  config.edges.mode = EdgeMode::kPaper;
  config.map.representation = Representation::kAll;
  config.map.min_hits = 1;
  config.map.confirm_within = 0;
  config.map.freeze_after = 0;
  config.matcher.mode = MatcherMode::kPublished;
  config.matcher.search_points = 1000000;
  config.matcher.max_restarts = 0;
  config.matcher.min_hit_ratio = config.matcher.relative_hit_ratio = 0.0;
  const auto run = [&](ScanVoxels scan_voxels) {
    config.mapper.scan_voxels = scan_voxels;
    return runOf(building().sweeps, 40, config);
  };
  const MappedRun edges = run(ScanVoxels::kEdges);
  EXPECT_EQ(0U, edges.lost);
  EXPECT_LT(evaluate(edges.trajectory, building().truth).ape_rmse_m, 0.15);
  EXPECT_GT(edges.voxels, 500U);
  EXPECT_LT(edges.voxels, run(ScanVoxels::kAll).voxels * 9 / 10);
}

TEST(Corridor, FifteenSecondsAreMapped) {
  const Walk walk = simulateWalk(sim::WorldName::Corridor, "16", 0, 150);
  const MappedRun run = runOf(walk.sweeps, walk.sweeps.size(), Config{});
  EXPECT_EQ(0U, run.lost);
  const TrajectoryErrors errors = evaluate(run.trajectory, walk.truth);
  RecordProperty("ape_m", std::to_string(errors.ape_rmse_m));
  RecordProperty("ape_deg", std::to_string(errors.ape_rmse_deg));
  EXPECT_LT(errors.ape_rmse_m, 0.05);
  EXPECT_LT(errors.ape_rmse_deg, 0.4);
  // Setting off after standing, where one ring draws one line: pitch and height are open until the
  // floor ahead has been seen.
  double worst = 0.0;
  for (const PoseError& error : errors.poses) worst = std::max(worst, error.ape_m);
  RecordProperty("worst_m", std::to_string(worst));
  EXPECT_LT(worst, 0.25);
}

constexpr size_t kFewSweeps = 40;

TEST(Determinism, ThreadsAndInstructionSetsGiveTheSameBits) {
  const MappedRun expected = runOf(building().sweeps, kFewSweeps, Config{});
  ASSERT_EQ(kFewSweeps, expected.trajectory.size());
  std::vector<Config> others(3);
  others[0].threads = 2;
  others[1].edges.instruction_set = InstructionSet::kPortable;
  others[2].edges.instruction_set = InstructionSet::kAvx2;
  for (size_t i = 0; i < others.size(); ++i) {
    if (i == 2 && !__builtin_cpu_supports("avx2")) continue;
    const MappedRun run = runOf(building().sweeps, kFewSweeps, others[i]);
    EXPECT_TRUE(sameTrajectory(expected.trajectory, run.trajectory)) << i;
    EXPECT_EQ(expected.voxels, run.voxels) << i;
  }
}

/// Clouds that no mapper can use, with stamps between `stamp` and the next sweep's.
std::vector<Sweep> garbageAfter(double stamp) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  std::vector<Sweep> garbage(6);
  for (int i = 0; i < 5000; ++i) {
    const auto value = static_cast<float>(i);
    garbage[1].points.push_back({nan, value, nan, 0});
    garbage[2].points.push_back({infinite, value, -infinite, nan});
    garbage[3].points.push_back({1e-3F * value / 5000, 0, 0, 0});  // within the least range
    garbage[4].points.push_back({1e6F + value, 1e30F, 0, 0});
  }
  for (int i = 0; i < 30; ++i) garbage[5].points.push_back({1.0F + static_cast<float>(i), 2, 3, 0});
  for (size_t i = 0; i < garbage.size(); ++i) {
    garbage[i].stamp = stamp + 0.01 * static_cast<double>(i + 1);
  }
  return garbage;
}

TEST(Garbage, BetweenGoodCloudsChangesNothing) {
  const MappedRun expected = runOf(building().sweeps, kFewSweeps, Config{});
  std::vector<Sweep> mixed = garbageAfter(-0.2);
  size_t garbage_count = mixed.size();
  for (size_t i = 0; i < kFewSweeps; ++i) {
    mixed.push_back(building().sweeps[i]);
    if (i % 10 != 3) continue;
    for (const Sweep& sweep : garbageAfter(mixed.back().stamp)) {
      mixed.push_back(sweep);
      ++garbage_count;
    }
    mixed.push_back(building().sweeps[i]);  // once more: stale
    ++garbage_count;
  }
  const MappedRun run = runOf(mixed, mixed.size(), Config{});
  EXPECT_EQ(garbage_count, run.lost);
  EXPECT_TRUE(sameTrajectory(expected.trajectory, run.trajectory));
}

TEST(Garbage, OfRandomPointsIsLostAndHarmless) {
  std::vector<Sweep> mixed;
  for (size_t i = 0; i < kFewSweeps; ++i) {
    mixed.push_back(building().sweeps[i]);
    if (i % 10 == 5) mixed.push_back(randomSweep(3, mixed.back().stamp + 0.05, 20000));
  }
  const MappedRun run = runOf(mixed, mixed.size(), Config{});
  EXPECT_EQ(4U, run.lost);
  const MappedRun expected = runOf(building().sweeps, kFewSweeps, Config{});
  EXPECT_EQ(kFewSweeps, run.trajectory.size());
  for (size_t i = 0; i < std::min(run.trajectory.size(), expected.trajectory.size()); ++i) {
    const auto change = differenceOf(expected.trajectory[i].pose, run.trajectory[i].pose);
    EXPECT_LT(change.metres, 0.01) << i;
  }
}

}  // namespace
}  // namespace edgevox::test
