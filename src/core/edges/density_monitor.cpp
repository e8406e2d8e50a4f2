// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/edges/density_monitor.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "edgevox/statistics.hpp"

namespace edgevox {
namespace {

constexpr size_t kFewVoxels = 100;         // a scan of fewer tells nothing
constexpr double kPause = 3.0;             // between two scans that are counted again [s]
constexpr double kSeries = 0.05;           // the sizes to choose are this times a power of 2 [m]
constexpr double kLargestSize = 6.4;       // of the series within the range of voxel_size [m]
constexpr EdgeThresholds kNoThresholds{};  // what is sparse does not depend on what is an edge

/// The next of the series.
double roundedUp(double size) {
  constexpr double kTolerance = 1e-6;
  return std::ldexp(kSeries, static_cast<int>(std::ceil(std::log2(size / kSeries) - kTolerance)));
}

}  // namespace

std::string textOf(const DensityWarning& warning) {
  std::array<char, 200> text;
  const auto percent = std::lround(100.0 * warning.share);
  if (warning.voxel_size > 0.0) {
    std::snprintf(text.data(), text.size(),
                  "too sparse: %ld %% of the occupied voxels stand alone; choose voxel_size %g or "
                  "more",
                  percent, warning.voxel_size);
  } else {
    std::snprintf(text.data(), text.size(),
                  "too sparse: %ld %% of the occupied voxels stand alone, and no voxel_size would "
                  "do: the points lie too far apart",
                  percent);
  }
  return text.data();
}

double sparseShare(const VoxelScan& scan, int doublings, const EdgeConfig& config, int threads) {
  BitGrid<16> occupied;
  BitGrid<16> edges;
  EdgeCount count;
  for (const ScanVoxel& voxel : scan.voxels) {
    count.occupied += occupied.set(coarser(voxel.index, 1 + doublings)) ? 1 : 0;
  }
  EdgeLabeller<16>(config, kNoThresholds, threads).label(occupied, occupied, edges, &count.sparse);
  return count.sparseShare();
}

std::optional<double> denserVoxelSize(const VoxelScan& scan, const EdgeConfig& config,
                                      int threads) {
  for (int doublings = 1;; ++doublings) {
    const double size = roundedUp(std::ldexp(2.0 * scan.voxel_size, doublings));
    if (size > kLargestSize) return std::nullopt;
    if (sparseShare(scan, doublings, config, threads) <= kSparseLimit) return size;
  }
}

DensityMonitor::DensityMonitor(const EdgeConfig& config, int threads, size_t window)
    : config_(config), threads_(threads), shares_(window), voxel_sizes_(window) {}

void DensityMonitor::add(const VoxelScan& scan, const EdgeCount& count) {
  if (count.occupied < kFewVoxels) return;
  shares_.push(count.sparseShare());
  if (count.sparseShare() <= kSparseLimit || !isDue(scan.stamp)) return;
  voxel_sizes_.push(
      denserVoxelSize(scan, config_, threads_).value_or(std::numeric_limits<double>::infinity()));
}

bool DensityMonitor::isDue(double stamp) {
  if (counted_ && std::abs(stamp - *counted_) < kPause) return false;
  counted_ = stamp;
  return true;
}

double DensityMonitor::share() const { return quantile(shares_.values(), 0.5); }

std::optional<DensityWarning> DensityMonitor::warning() const {
  const double median = share();
  // Above the limit at least one scan of the window was; the first of all such was counted again.
  if (!(median > kSparseLimit)) return std::nullopt;
  const double size = upperMedian(voxel_sizes_.values());  // of the series
  return DensityWarning{median, std::isfinite(size) ? size : 0.0};
}

}  // namespace edgevox
