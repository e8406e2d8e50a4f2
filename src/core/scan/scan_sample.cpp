// SPDX-License-Identifier: BSD-3-Clause
#include "core/scan/scan_sample.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "edgevox/grid/block_grid.hpp"

namespace edgevox {
namespace {

constexpr int kSpreadLevels = 2;
constexpr size_t kDeskewPoses = 512;

/// Appends positions of voxels, one in each that is 2^levels times larger and has none, in an
/// order fixed by hash, until there are `count`.
void addSpread(const VoxelScan& scan, int levels, size_t count, std::vector<bool>& taken,
               std::vector<size_t>& sample) {
  BitGrid<8> covered;
  for (const size_t i : sample) covered.set(coarser(scan.voxels[i].index, levels));
  std::vector<std::pair<uint64_t, size_t>> ranked;
  for (size_t i = 0; i < scan.voxels.size(); ++i) {
    const VoxelIndex& index = scan.voxels[i].index;
    if (!taken[i] && covered.set(coarser(index, levels))) ranked.emplace_back(voxelHash(index), i);
  }
  const size_t wanted = std::min(count - sample.size(), ranked.size());
  const auto last = ranked.begin() + static_cast<std::ptrdiff_t>(wanted);
  if (last != ranked.end()) std::nth_element(ranked.begin(), last, ranked.end());
  std::sort(ranked.begin(), last);
  for (size_t i = 0; i < wanted; ++i) {
    sample.push_back(ranked[i].second);
    taken[ranked[i].second] = true;
  }
}

}  // namespace

std::vector<size_t> sampleVoxels(const VoxelScan& scan, size_t count) {
  std::vector<size_t> sample;
  std::vector<bool> taken(scan.voxels.size(), false);
  for (int levels = kSpreadLevels; levels >= 0 && sample.size() < count; --levels) {
    addSpread(scan, levels, count, taken, sample);
  }
  return sample;
}

std::vector<Eigen::Vector3d> sampleCentroids(const VoxelScan& scan, size_t count) {
  std::vector<Eigen::Vector3d> centroids;
  for (const size_t position : sampleVoxels(scan, count)) {
    centroids.push_back(scan.voxels[position].centroid.cast<double>());
  }
  return centroids;
}

SweepTime sweepTime(const VoxelScan& scan) {
  if (scan.voxels.empty()) return {};
  const auto [first, last] = std::minmax_element(
      scan.voxels.begin(), scan.voxels.end(),
      [](const ScanVoxel& a, const ScanVoxel& b) { return a.time_offset < b.time_offset; });
  return {static_cast<double>(first->time_offset), static_cast<double>(last->time_offset)};
}

Deskew::Deskew(const SweepTime& sweep, const Twist& twist) : sweep_(sweep) {
  if (sweep.instant()) return;
  const double span = sweep.last - sweep.first;
  poses_per_second_ = (kDeskewPoses - 1) / span;
  poses_.reserve(kDeskewPoses);
  for (size_t i = 0; i < kDeskewPoses; ++i) {
    const double fraction = static_cast<double>(i) / (kDeskewPoses - 1);
    poses_.push_back(moved(twist, (fraction - 0.5) * span));
  }
}

Eigen::Vector3d Deskew::operator()(const ScanVoxel& voxel) const {
  const Eigen::Vector3d point = voxel.centroid.cast<double>();
  if (poses_.empty()) return point;
  const double at = (static_cast<double>(voxel.time_offset) - sweep_.first) * poses_per_second_;
  return poses_[static_cast<size_t>(std::lround(at))] * point;
}

}  // namespace edgevox
