// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/paper_data.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>

#include <Eigen/Eigenvalues>

#include "core/edges/dense_kernel.hpp"
#include "core/map/voxel_tree.hpp"
#include "edgevox/edges/edge_extractor.hpp"
#include "edgevox/stage_timer.hpp"
#include "evaluation/octree_leaves.hpp"

namespace edgevox {
namespace {

constexpr int kReach = 2;           // of gradient and tensor
constexpr size_t kHistograms = 10;  // scans
constexpr int kTimings = 5;

template <typename Visit>
void forEachNear(const VoxelIndex& centre, const Visit& visit) {
  for (int z = -kReach; z <= kReach; ++z) {
    for (int y = -kReach; y <= kReach; ++y) {
      for (int x = -kReach; x <= kReach; ++x) {
        visit(
            VoxelIndex{centre.x + x, centre.y + y, centre.z + z},
            std::array<size_t, 3>{static_cast<size_t>(x + kReach), static_cast<size_t>(y + kReach),
                                  static_cast<size_t>(z + kReach)});
      }
    }
  }
}

Eigen::Vector3d gradientAt(const BitGrid<16>& occupied, const VoxelIndex& v,
                           const kernel::DenseTaps& taps) {
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  forEachNear(v, [&](const VoxelIndex& near, const std::array<size_t, 3>& at) {
    if (!occupied.test(near)) return;
    const auto& [x, y, z] = at;
    gradient.x() += taps.slope[x] * taps.smooth[y] * taps.smooth[z];
    gradient.y() += taps.smooth[x] * taps.slope[y] * taps.smooth[z];
    gradient.z() += taps.smooth[x] * taps.smooth[y] * taps.slope[z];
  });
  return gradient;
}

/// Gradients, computed once where several tensors need them.
class Gradients {
 public:
  Gradients(const BitGrid<16>& occupied, const kernel::DenseTaps& taps)
      : occupied_(occupied), taps_(taps) {}

  Eigen::Vector3d at(const VoxelIndex& v) {
    const auto next = static_cast<uint32_t>(values_.size());
    const uint32_t slot = slots_.insert(v, next);
    if (slot == next) values_.push_back(gradientAt(occupied_, v, taps_));
    return values_[slot];
  }

 private:
  const BitGrid<16>& occupied_;
  const kernel::DenseTaps& taps_;
  SlotGrid<8> slots_;
  std::vector<Eigen::Vector3d> values_;
};

size_t mergedLeavesOf(const BitGrid<16>& voxels) {
  std::vector<VoxelIndex> leaves = inTreeOrder(voxels);
  for (VoxelIndex& v : leaves) v = {v.x + kIndexLimit, v.y + kIndexLimit, v.z + kIndexLimit};
  return mergedLeafCount(std::move(leaves));
}

/// In voxels.
Eigen::Vector3i extentOf(const BitGrid<16>& voxels) {
  Eigen::Vector3i first = Eigen::Vector3i::Constant(kIndexLimit);
  Eigen::Vector3i last = -first;
  voxels.forEach([&](const VoxelIndex& v) {
    const Eigen::Vector3i index(v.x, v.y, v.z);
    first = first.cwiseMin(index);
    last = last.cwiseMax(index);
  });
  return (last - first).cwiseMax(-1) + Eigen::Vector3i::Ones();
}

void addRatios(const BitGrid<16>& occupied, PaperData& data) {
  for (const Eigen::Vector3d& values : publishedEigenvalues(occupied, inTreeOrder(occupied))) {
    const double ratio = values[2] > 0 ? values[1] / values[2] : 0.0;
    const auto bin = static_cast<size_t>(std::clamp(ratio, 0.0, 1.0) * PaperData::kBins);
    ++data.ratios[std::min(bin, PaperData::kBins - 1)];
  }
}

std::vector<ExtractionTime> timeExtraction(const VoxelScan& scan, const EdgeConfig& edges) {
  std::vector<ExtractionTime> times;
  const int processors = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  for (int threads = 1; threads <= processors; threads *= 2) {
    EdgeExtractor extractor(edges, threads);
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kTimings; ++i) {
      VoxelScan copy = scan;
      StageTimer timer(Clock::kWall);
      extractor.extract(copy);
      least = std::min(least, 1e3 * timer.lap());
    }
    times.push_back({threads, least});
  }
  return times;
}

}  // namespace

std::vector<Eigen::Vector3d> publishedEigenvalues(const BitGrid<16>& occupied,
                                                  const std::vector<VoxelIndex>& voxels) {
  const kernel::DenseTaps taps = kernel::paperTaps();
  Gradients gradients(occupied, taps);
  std::vector<Eigen::Vector3d> eigenvalues;
  eigenvalues.reserve(voxels.size());
  for (const VoxelIndex& v : voxels) {
    Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
    forEachNear(v, [&](const VoxelIndex& near, const std::array<size_t, 3>& at) {
      const Eigen::Vector3d g = gradients.at(near);
      tensor += taps.weight[at[0]] * taps.weight[at[1]] * taps.weight[at[2]] * g * g.transpose();
    });
    eigenvalues.push_back(
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor, Eigen::EigenvaluesOnly)
            .eigenvalues());
  }
  return eigenvalues;
}

PaperData measureData(const ScanStream& scans, const PaperOptions& options) {
  const double size = options.config.voxel_size;
  PaperData data;
  BitGrid<16> map;
  BitGrid<16> map_edges;
  VoxelScan largest;
  size_t compressed = 0;
  const size_t histogram_step = std::max<size_t>(1, options.recording.most / kHistograms);
  const auto add = [&](const PaperScan& scan, const PaperRecord& record) {
    BitGrid<16> occupied;
    for (const ScanVoxel& voxel : scan.voxels.voxels) occupied.set(voxel.index);
    if (data.scans % histogram_step == 0) addRatios(occupied, data);
    ++data.scans;
    data.points += static_cast<double>(scan.scan.points_read);
    data.voxels += static_cast<double>(record.voxels);
    data.edges += static_cast<double>(record.edges);
    data.merged_leaves += static_cast<double>(mergedLeavesOf(occupied));
    if (record.edges > 0) {
      data.compression += static_cast<double>(record.voxels) / static_cast<double>(record.edges);
      ++compressed;
    }
    addVoxels(scan.voxels, scan.T_map_sensor, size, map);
    addVoxels(edgeVoxels(scan.scan), scan.T_map_sensor, size, map_edges);
    if (scan.scan.voxels.size() > largest.voxels.size()) largest = scan.scan;
  };
  forEachPaperScan(scans, options, PaperVoxels::kAll, add);
  if (data.scans == 0) throw std::invalid_argument("the recording has no scan with a pose");
  const auto count = static_cast<double>(data.scans);
  for (double* sum : {&data.points, &data.voxels, &data.edges, &data.merged_leaves}) *sum /= count;
  data.compression /= std::max<double>(1.0, static_cast<double>(compressed));
  data.map_voxels = map.voxelCount();
  data.map_edges = map_edges.voxelCount();
  data.map_merged_leaves = mergedLeavesOf(map);
  data.extent = size * extentOf(map).cast<double>();
  data.extraction = timeExtraction(largest, publishedEdges(options.config));
  return data;
}

}  // namespace edgevox
