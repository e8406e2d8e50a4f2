// SPDX-License-Identifier: BSD-3-Clause
#include "scan_sample.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "edgevox/block_grid.hpp"

namespace edgevox {
namespace {

constexpr int kSpreadLevels = 2;   // one sample in a voxel 2^kSpreadLevels scan voxels wide
constexpr size_t kDeskewPoses = 512;

/// Positions of the first voxel in each coarser one.
std::vector<size_t> thinned(const VoxelScan& scan, int levels) {
  BitGrid<8> seen;
  std::vector<size_t> kept;
  for (size_t i = 0; i < scan.voxels.size(); ++i) {
    if (seen.set(coarser(scan.voxels[i].index, levels))) kept.push_back(i);
  }
  return kept;
}

}  // namespace

std::vector<size_t> sampleVoxels(const VoxelScan& scan, size_t count) {
  std::vector<std::pair<uint64_t, size_t>> ranked;
  for (const size_t i : thinned(scan, kSpreadLevels)) {
    ranked.emplace_back(voxelHash(scan.voxels[i].index), i);
  }
  const size_t kept = std::min(count, ranked.size());
  std::partial_sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(kept),
                    ranked.end());
  std::vector<size_t> sample(kept);
  for (size_t i = 0; i < kept; ++i) sample[i] = ranked[i].second;
  return sample;
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
