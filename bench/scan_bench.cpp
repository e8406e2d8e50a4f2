// SPDX-License-Identifier: BSD-3-Clause
// One cloud: voxels and edges, beside PCL's VoxelGrid and plainer ways to the same labels.
#include <algorithm>
#include <array>
#include <cmath>

#include <pcl/filters/voxel_grid.h>

#include "benchmarks.hpp"
#include "core/edges/dense_kernel.hpp"
#include "core/edges/edge_kernel.hpp"
#include "core/grid/neighbourhood.hpp"
#include "edgevox/edges/edge_extractor.hpp"
#include "naive_kernel.hpp"
#include "pcl_clouds.hpp"
#include "sequence.hpp"

namespace edgevox::bench {
namespace {

using benchmark::State;
using Grid = BitGrid<16>;

void countItems(State& state, size_t items) {
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(items));
}

void voxelize(State& state, const std::string& name) {
  const Sequence& s = sequence(name);
  const CloudView& cloud = s.clouds[s.sample()].view;
  Voxelizer voxelizer(s.config.voxelizer, s.config.voxel_size);
  for (auto _ : state) benchmark::DoNotOptimize(voxelizer.voxelize(cloud));
  countItems(state, cloud.width * cloud.height);
}

void voxelGrid(State& state, const std::string& name) {
  const Sequence& s = sequence(name);
  const auto cloud = pclCloud(s.clouds[s.sample()].view, s.config.voxelizer);
  const auto leaf = static_cast<float>(s.scans.front().voxel_size);
  for (auto _ : state) benchmark::DoNotOptimize(filtered(cloud, leaf));
  countItems(state, cloud->size());
}

void extract(State& state, const std::string& name) {
  const Sequence& s = sequence(name);
  VoxelScan scan = s.scans[s.sample()];
  EdgeExtractor extractor(s.config.edges, 1);
  EdgeCount count;
  for (auto _ : state) count = extractor.extract(scan);
  countItems(state, count.occupied);
}

Grid occupiedOf(const VoxelScan& scan) {
  Grid occupied;
  for (const ScanVoxel& voxel : scan.voxels) occupied.set(coarser(voxel.index, 1));
  return occupied;
}

/// The thresholds of the default mode, for a tensor in which a plane has 2^19.
kernel::DenseThresholds denseThresholds(const EdgeConfig& config) {
  return {std::ldexp(config.magnitude, 19), config.scan.ratio / (1.0 + config.scan.ratio), false};
}

void labelDense(const Grid& grid, const VoxelIndex& block, const uint32_t* targets, uint32_t* edges,
                const kernel::DenseThresholds& thresholds) {
  const Neighbourhood<16, kernel::kDenseHalo> rows(grid, block);
  kernel::labelBlockDense<16, float>(rows.data(), targets, edges, kernel::integerTaps(),
                                     thresholds);
}

void labelNaive(const Grid& grid, const VoxelIndex& block, const uint32_t* targets, uint32_t* edges,
                const kernel::DenseThresholds& thresholds) {
  const Neighbourhood<16, kernel::kHalo> rows(grid, block);
  labelBlockNaive(rows.data(), targets, edges, thresholds);
}

template <typename LabelBlock>
void labelBlocks(const Grid& grid, const EdgeConfig& config, const LabelBlock& labelBlock,
                 Grid& edges) {
  std::array<uint32_t, Grid::Layout::kRows> targets;
  std::array<uint32_t, Grid::Layout::kRows> found;
  for (size_t slot = 0; slot < grid.blockCount(); ++slot) {
    const VoxelIndex& block = grid.blockIndex(slot);
    std::copy(grid.block(slot).begin(), grid.block(slot).end(), targets.begin());
    labelBlock(grid, block, targets.data(), found.data(), denseThresholds(config));
    std::copy(found.begin(), found.end(), edges.editBlock(edges.insertBlock(block)).begin());
  }
}

size_t countDifferences(const Grid& a, const Grid& b) {
  size_t count = 0;
  a.forEach([&](const VoxelIndex& v) { count += b.test(v) ? 0 : 1; });
  b.forEach([&](const VoxelIndex& v) { count += a.test(v) ? 0 : 1; });
  return count;
}

EdgeConfig with(EdgeConfig config, InstructionSet instruction_set) {
  config.instruction_set = instruction_set;
  return config;
}

EdgeThresholds withoutSupport(const Sequence& s) { return {s.config.edges.scan.ratio, 0.0}; }

/// Labels of one scan's blocks without the support filter, by the fast kernel.
void labelFast(State& state, const std::string& name, InstructionSet instruction_set) {
  const Sequence& s = sequence(name);
  const Grid occupied = occupiedOf(s.scans[s.sample()]);
  const EdgeLabeller<16> labeller(with(s.config.edges, instruction_set), withoutSupport(s), 1);
  Grid edges;
  for (auto _ : state) labeller.label(occupied, occupied, edges);
  countItems(state, occupied.voxelCount());
}

/// The same by a kernel that works in floating point.
template <typename LabelBlock>
void labelPlain(State& state, const std::string& name, const LabelBlock& labelBlock) {
  const Sequence& s = sequence(name);
  const Grid occupied = occupiedOf(s.scans[s.sample()]);
  Grid edges;
  for (auto _ : state) labelBlocks(occupied, s.config.edges, labelBlock, edges);
  Grid expected;
  EdgeLabeller<16>(s.config.edges, withoutSupport(s), 1).label(occupied, occupied, expected);
  state.counters["different_labels"] = static_cast<double>(countDifferences(edges, expected));
  countItems(state, occupied.voxelCount());
}

}  // namespace

void addScanBenchmarks(const std::string& sequence_name) {
  add("voxelize", sequence_name, voxelize);
  add("pcl_voxel_grid", sequence_name, voxelGrid);
  add("extract", sequence_name, extract);
  add("kernel_fast", sequence_name,
      [](State& state, const std::string& name) { labelFast(state, name, InstructionSet::kAuto); });
  add("kernel_portable", sequence_name, [](State& state, const std::string& name) {
    labelFast(state, name, InstructionSet::kPortable);
  });
  add("kernel_dense", sequence_name,
      [](State& state, const std::string& name) { labelPlain(state, name, labelDense); });
  add("kernel_naive", sequence_name,
      [](State& state, const std::string& name) { labelPlain(state, name, labelNaive); });
}

}  // namespace edgevox::bench
