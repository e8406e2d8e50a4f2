// SPDX-License-Identifier: BSD-3-Clause
// The labels of the fast kernels against the naive reference, bit by bit, and what they must not
// depend on.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "core/edges/dense_kernel.hpp"
#include "core/grid/neighbourhood.hpp"
#include "edgevox/edges/edge_extractor.hpp"
#include "support/reference_extractor.hpp"
#include "support/scenes.hpp"

namespace edgevox::test {
namespace {

template <int kSide = 16>
Voxels labelled(const Voxels& occupied, const EdgeConfig& config, double support, int threads = 1) {
  const auto grid = gridOf<kSide>(occupied);
  BitGrid<kSide> edges;
  EdgeLabeller<kSide>(config, {config.scan.ratio, support}, threads).label(grid, grid, edges);
  return voxelsOf(edges);
}

EdgeConfig paperMode() {
  EdgeConfig config;
  config.mode = EdgeMode::kPaper;
  return config;
}

EdgeConfig withInstructionSet(InstructionSet instruction_set) {
  EdgeConfig config;
  config.instruction_set = instruction_set;
  return config;
}

struct NamedVoxels {
  std::string name;
  Voxels voxels;
};

/// Clouds of several densities and every shape, some on top of noise; all across block borders.
std::vector<NamedVoxels> variedOccupancy(uint32_t seed) {
  Random random(seed);
  std::vector<NamedVoxels> all;
  for (const double density : {0.02, 0.1, 0.25, 0.6, 1.0}) {
    all.push_back({"cloud " + std::to_string(density), randomCloud(random, 14, density)});
  }
  all.push_back({"plane", planeScene(random, 30).voxels});
  all.push_back({"noisy plane", planeScene(random, 24, 0.3).voxels});
  for (const double angle : {60.0, 90.0, 120.0, 140.0}) {
    all.push_back(
        {"dihedral " + std::to_string(angle), dihedralScene(random, angle, 24, 14).voxels});
  }
  all.push_back({"corner", cornerScene(random, 16).voxels});
  all.push_back({"noisy corner", cornerScene(random, 16, 0.3).voxels});
  all.push_back({"rod", rodScene(random, 40).voxels});
  Voxels upright;
  for (int32_t z = 0; z < 30; ++z) upright.push_back({0, 0, z});
  all.push_back({"upright rod", upright});
  all.push_back({"rings", ringScene(random, 3, 15).voxels});
  Voxels littered = cornerScene(random, 16).voxels;
  const Voxels noise = randomCloud(random, 24, 0.03);
  littered.insert(littered.end(), noise.begin(), noise.end());
  all.push_back({"corner in clutter", sorted(littered)});
  for (NamedVoxels& named : all) {
    named.voxels = translated(std::move(named.voxels), random.voxelIn(-40, 40));
  }
  return all;
}

void expectReferenceLabels(const EdgeConfig& config, double support, uint32_t seed) {
  size_t edges = 0;
  size_t occupied = 0;
  for (const auto& [name, voxels] : variedOccupancy(seed)) {
    const Voxels expected =
        ReferenceExtractor(voxels).edges(config.magnitude, {config.scan.ratio, support});
    EXPECT_TRUE(sameVoxels(expected, labelled(voxels, config, support))) << name;
    edges += expected.size();
    occupied += voxels.size();
  }
  EXPECT_GT(edges, occupied / 20);  // both answers occur
  EXPECT_LT(edges, occupied - occupied / 20);
}

TEST(Reference, CountsPositiveEigenvaluesExactly) {
  ReferenceExtractor::IntegerMatrix q;  // q q^T = 9 I
  q << 1, 2, 2, 2, 1, -2, 2, -2, 1;
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const VoxelIndex d = random.voxelIn(-2, 2);
    const ReferenceExtractor::IntegerVector eigenvalues(d.x, d.y, d.z);
    const ReferenceExtractor::IntegerMatrix m = q * eigenvalues.asDiagonal() * q.transpose();
    EXPECT_EQ((eigenvalues.array() > 0).count(), positiveEigenvalues(m)) << m;
  }
}

TEST(Reference, AnAlignedPlaneHasTheDocumentedEigenvalues) {
  const ReferenceExtractor reference(alignedPlaneScene(20).voxels);
  ReferenceExtractor::IntegerMatrix plane = ReferenceExtractor::IntegerMatrix::Zero();
  plane(0, 0) = 1 << 19;
  EXPECT_EQ(plane, reference.structureTensor({0, 10, 10}));
  EXPECT_NEAR(10.016, reference.paperEigenvalues({0, 10, 10})[2], 0.001);
}

TEST(DefaultMode, EqualsTheReferenceWithoutSupport) { expectReferenceLabels({}, 0.0, 2); }

TEST(DefaultMode, EqualsTheReferenceWithSupport) {
  expectReferenceLabels({}, 0.3, 3);
  expectReferenceLabels({}, 0.5, 4);
  expectReferenceLabels({}, 0.75, 5);
}

TEST(DefaultMode, EqualsTheReferenceAtOtherThresholds) {
  EdgeConfig config;
  config.magnitude = 0.3;
  config.scan.ratio = 0.01;
  expectReferenceLabels(config, 0.0, 6);
  config.magnitude = 0.02;
  config.scan.ratio = 0.35;
  expectReferenceLabels(config, 0.3, 7);
}

TEST(PaperMode, EqualsTheReference) {
  int undecided = 0;
  for (const auto& [name, voxels] : variedOccupancy(8)) {
    const ReferenceExtractor reference(voxels);
    const auto fast = gridOf<16>(labelled(voxels, paperMode(), 0.0));
    for (const VoxelIndex& v : voxels) {
      const bool decided = ((reference.paperEigenvalues(v).array() - 1.0).abs() > 1e-9).all();
      undecided += decided ? 0 : 1;
      if (decided) {
        ASSERT_EQ(reference.isPaperEdge(v), fast.test(v)) << name;
      }
    }
  }
  RecordProperty("undecided", undecided);
  EXPECT_LE(undecided, 20);
}

TEST(PaperMode, UsesNeitherSupportNorThresholds) {
  Random random(9);
  const Voxels voxels = planeScene(random, 30, 0.3).voxels;
  EdgeConfig other = paperMode();
  other.magnitude = 0.5;
  other.scan.ratio = 0.5;
  const Voxels edges = labelled(voxels, paperMode(), 0.0);
  EXPECT_FALSE(edges.empty());
  EXPECT_TRUE(sameVoxels(edges, labelled(voxels, other, 0.75)));
}

template <int kSide>
size_t sparseCount(const Voxels& voxels, const EdgeConfig& config, int threads = 1) {
  const auto grid = gridOf<kSide>(voxels);
  BitGrid<kSide> edges;
  size_t sparse = 12345;  // must be overwritten
  EdgeLabeller<kSide>(config, {config.scan.ratio, 0.3}, threads).label(grid, grid, edges, &sparse);
  EXPECT_TRUE(sameVoxels(labelled<kSide>(voxels, config, 0.3), voxelsOf(edges)));
  return sparse;
}

/// Sparse ones among them: lines far apart, and single voxels.
std::vector<NamedVoxels> sparseOccupancy(uint32_t seed) {
  auto all = variedOccupancy(seed);
  Random random(seed);
  for (const double spacing : {4.0, 6.0, 8.0}) {
    all.push_back({"rings " + std::to_string(spacing), ringScene(random, spacing, 15).voxels});
  }
  all.push_back({"thin cloud", randomCloud(random, 24, 0.004)});
  all.push_back({"single voxel", {{3, -5, 7}}});
  return all;
}

TEST(Sparse, EqualsTheReference) {
  size_t sparse = 0;
  size_t occupied = 0;
  EdgeConfig other;  // the share does not depend on what an edge is
  other.magnitude = 0.3;
  other.scan.ratio = 0.01;
  for (const auto& [name, voxels] : sparseOccupancy(18)) {
    const ReferenceExtractor reference(voxels);
    const auto expected = static_cast<size_t>(std::count_if(
        voxels.begin(), voxels.end(), [&](const VoxelIndex& v) { return reference.isSparse(v); }));
    EXPECT_EQ(expected, sparseCount<16>(voxels, {})) << name;
    EXPECT_EQ(expected, sparseCount<8>(voxels, {})) << name;
    EXPECT_EQ(expected, sparseCount<32>(voxels, {}, 4)) << name;
    EXPECT_EQ(expected, sparseCount<16>(voxels, other)) << name;
    EXPECT_EQ(expected, sparseCount<16>(voxels, withInstructionSet(InstructionSet::kPortable)))
        << name;
    sparse += expected;
    occupied += voxels.size();
  }
  EXPECT_GT(sparse, occupied / 100);  // both answers occur
  EXPECT_LT(sparse, occupied / 2);
}

TEST(Sparse, EqualsTheReferenceInPaperMode) {
  constexpr double kThreshold = 1.0016;  // a tenth of a plane's
  for (const auto& [name, voxels] : sparseOccupancy(19)) {
    const ReferenceExtractor reference(voxels);
    size_t least = 0;
    size_t most = 0;
    for (const VoxelIndex& v : voxels) {
      const double largest = reference.paperEigenvalues(v)[2];
      least += largest < kThreshold - 1e-9 ? 1 : 0;
      most += largest < kThreshold + 1e-9 ? 1 : 0;
    }
    const size_t counted = sparseCount<16>(voxels, paperMode());
    EXPECT_LE(least, counted) << name;
    EXPECT_GE(most, counted) << name;
    EXPECT_EQ(counted, sparseCount<8>(voxels, paperMode(), 2)) << name;
  }
}

TEST(Independence, OfTheBlockEdge) {
  for (const EdgeConfig& config : {EdgeConfig{}, paperMode()}) {
    for (const auto& [name, voxels] : variedOccupancy(10)) {
      const Voxels expected = labelled<16>(voxels, config, 0.3);
      EXPECT_TRUE(sameVoxels(expected, labelled<8>(voxels, config, 0.3))) << name;
      EXPECT_TRUE(sameVoxels(expected, labelled<32>(voxels, config, 0.3))) << name;
    }
  }
}

TEST(Independence, OfTheNumberOfThreads) {
  for (const EdgeConfig& config : {EdgeConfig{}, paperMode()}) {
    for (const auto& [name, voxels] : variedOccupancy(11)) {
      const Voxels expected = labelled<8>(voxels, config, 0.3, 1);
      EXPECT_TRUE(sameVoxels(expected, labelled<8>(voxels, config, 0.3, 2))) << name;
      EXPECT_TRUE(sameVoxels(expected, labelled<8>(voxels, config, 0.3, 4))) << name;
    }
  }
}

template <int kSide>
void expectSameLabelsWithAvx2(const Voxels& voxels) {
  const auto portable = withInstructionSet(InstructionSet::kPortable);
  const auto avx2 = withInstructionSet(InstructionSet::kAvx2);
  for (const double support : {0.0, 0.3}) {
    EXPECT_TRUE(sameVoxels(labelled<kSide>(voxels, portable, support),
                           labelled<kSide>(voxels, avx2, support)));
  }
}

TEST(Independence, OfTheInstructionSet) {
  try {
    EdgeLabeller<16>(withInstructionSet(InstructionSet::kAvx2), {}, 1);
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string::npos, std::string(error.what()).find("edges/instruction_set"));
    GTEST_SKIP() << error.what();
  }
  for (const auto& [name, voxels] : variedOccupancy(12)) {
    SCOPED_TRACE(name);
    expectSameLabelsWithAvx2<8>(voxels);
    expectSameLabelsWithAvx2<16>(voxels);
    expectSameLabelsWithAvx2<32>(voxels);
  }
}

TEST(Independence, OfTheOffset) {
  Random random(13);
  Voxels voxels = cornerScene(random, 16, 0.3).voxels;
  const int32_t edge_of_range = kIndexLimit - 40;  // the scene's extent is below 40
  std::vector<VoxelIndex> offsets = {{1, 0, 0},
                                     {-8, 16, -32},
                                     {edge_of_range, edge_of_range, edge_of_range},
                                     {-edge_of_range, -edge_of_range, -edge_of_range}};
  for (int i = 0; i < 20; ++i) offsets.push_back(random.voxelIn(-1000, 1000));
  for (const EdgeConfig& config : {EdgeConfig{}, paperMode()}) {
    const Voxels edges = labelled(voxels, config, 0.3);
    ASSERT_FALSE(edges.empty());
    for (const VoxelIndex& offset : offsets) {
      EXPECT_TRUE(
          sameVoxels(translated(edges, offset), labelled(translated(voxels, offset), config, 0.3)));
    }
  }
}

/// Voxels at the very border of the grid's range, in the corner all of whose neighbours lie out
/// of it.
TEST(Independence, OfTheBorderOfTheRange) {
  Random random(14);
  const Voxels voxels = randomCloud(random, 12, 0.3);  // indices -6..5
  const Voxels edges = labelled(voxels, {}, 0.0);
  const int32_t up = kIndexLimit - 6;
  const int32_t down = -kIndexLimit + 6;
  for (const VoxelIndex& offset : {VoxelIndex{up, up, up}, VoxelIndex{down, down, down}}) {
    EXPECT_TRUE(
        sameVoxels(translated(edges, offset), labelled(translated(voxels, offset), {}, 0.0)));
  }
}

TEST(Targets, OtherLabelsStay) {
  Random random(15);
  const Voxels voxels = cornerScene(random, 20).voxels;
  const auto occupied = gridOf<16>(voxels);
  Voxels targets, others;
  for (const VoxelIndex& v : voxels) (random.chance(0.5) ? targets : others).push_back(v);
  auto edges = gridOf<16>(voxels);  // all of them, to begin with
  EdgeLabeller<16>({}, {EdgeConfig{}.scan.ratio, 0.3}, 1)
      .label(occupied, gridOf<16>(targets), edges);

  const auto truth = gridOf<16>(labelled(voxels, {}, 0.3));
  for (const VoxelIndex& v : targets) ASSERT_EQ(truth.test(v), edges.test(v));
  for (const VoxelIndex& v : others) ASSERT_TRUE(edges.test(v));
}

/// Cuts a cloud in half: how far from the cut labels change [voxels].
int farthestChange(const EdgeConfig& config, const Voxels& voxels, int32_t VoxelIndex::*axis) {
  Voxels half;
  for (const VoxelIndex& v : voxels) {
    if (v.*axis < 0) half.push_back(v);
  }
  const auto whole_edges = gridOf<16>(labelled(voxels, config, 0.3));
  const auto half_edges = gridOf<16>(labelled(half, config, 0.3));
  int farthest = 0;
  for (const VoxelIndex& v : half) {
    if (whole_edges.test(v) != half_edges.test(v)) farthest = std::max(farthest, -(v.*axis));
  }
  return farthest;
}

TEST(Reach, IsHowFarAChangeActs) {
  Random random(16);
  for (const EdgeConfig& config : {EdgeConfig{}, paperMode()}) {
    const int reach = EdgeLabeller<16>(config, config.scan, 1).reach();
    int farthest = 0;
    for (int i = 0; i < 3; ++i) {
      const Voxels voxels = randomCloud(random, 32, 0.2);
      for (const auto axis : {&VoxelIndex::x, &VoxelIndex::y, &VoxelIndex::z}) {
        farthest = std::max(farthest, farthestChange(config, voxels, axis));
      }
    }
    EXPECT_EQ(reach, farthest);
  }
}

/// Whether the middle eigenvalue of the tensor before rounding lies so near to the threshold that
/// the integer kernel's rounding (16 a component and of the threshold) may decide otherwise.
bool nearThreshold(const ReferenceExtractor& reference, const VoxelIndex& v,
                   const kernel::DenseThresholds& thresholds) {
  const Eigen::Matrix3d tensor = reference.structureTensor(v).cast<double>();
  const double middle = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor).eigenvalues()[1];
  const double t = std::max(thresholds.magnitude, thresholds.rho * tensor.trace());
  return std::abs(middle - t) < 100.0;
}

template <int kSide>
Voxels labelledDense(const Voxels& voxels, const kernel::DenseThresholds& thresholds) {
  const auto grid = gridOf<kSide>(voxels);
  BitGrid<kSide> edges;
  for (size_t slot = 0; slot < grid.blockCount(); ++slot) {
    const VoxelIndex& block = grid.blockIndex(slot);
    const Neighbourhood<kSide, kernel::kDenseHalo> rows(grid, block);
    std::array<uint32_t, kSide * kSide> targets, found;
    std::copy(grid.block(slot).begin(), grid.block(slot).end(), targets.begin());
    kernel::labelBlockDense<kSide, double>(rows.data(), targets.data(), found.data(),
                                           kernel::integerTaps(), thresholds);
    auto& out = edges.editBlock(edges.insertBlock(block));
    for (size_t row = 0; row < out.size(); ++row) {
      out[row] = static_cast<typename BitGrid<kSide>::Row>(found[row]);
    }
  }
  return voxelsOf(edges);
}

TEST(DenseKernel, AgreesWithTheIntegerKernelOnIntegerTaps) {
  const EdgeConfig config;
  const kernel::DenseThresholds thresholds{config.magnitude * (1 << 19),
                                           config.scan.ratio / (1.0 + config.scan.ratio), false};
  size_t compared = 0;
  size_t near = 0;
  for (const auto& [name, voxels] : variedOccupancy(17)) {
    const ReferenceExtractor reference(voxels);
    const Voxels dense = labelledDense<16>(voxels, thresholds);
    EXPECT_TRUE(sameVoxels(dense, labelledDense<8>(voxels, thresholds))) << name;
    EXPECT_TRUE(sameVoxels(dense, labelledDense<32>(voxels, thresholds))) << name;
    const auto dense_grid = gridOf<16>(dense);
    const auto integer_grid = gridOf<16>(labelled(voxels, config, 0.0));
    for (const VoxelIndex& v : voxels) {
      const bool skip = nearThreshold(reference, v, thresholds);
      ++(skip ? near : compared);
      if (!skip) {
        ASSERT_EQ(integer_grid.test(v), dense_grid.test(v)) << name;
      }
    }
  }
  RecordProperty("near_threshold", static_cast<int>(near));
  EXPECT_LT(near, compared / 100);
}

}  // namespace
}  // namespace edgevox::test
