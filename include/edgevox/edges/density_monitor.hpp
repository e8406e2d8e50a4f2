// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include "edgevox/config.hpp"
#include "edgevox/edges/edge_extractor.hpp"
#include "edgevox/grid/voxel.hpp"
#include "edgevox/ring_buffer.hpp"
#include "edgevox/scan/voxel_scan.hpp"

namespace edgevox {

/// Largest share of sparse voxels (EdgeCount::sparse) of a scan whose edges are of use. Medians at
/// 5, 10 and 20 cm: handheld .276 .136 .065, where 10 cm does well; street .297 .147 .085;
/// simulated corridor .182 .125 .087 (16 lines), building .158 .070 .031 (32), .138 .078 .037 (16).
/// Points that are dense along lines far apart are not sparse: the last at 5 cm is a borderline
/// case.
constexpr double kSparseLimit = 0.14;

/// That voxels are smaller than the spacing of the points.
struct DensityWarning {
  double share = 0.0;       ///< of sparse voxels, median over scans
  double voxel_size = 0.0;  ///< to choose or exceed [m]; 0: none of a map would do
};

/// The warning in words, with what to do.
std::string textOf(const DensityWarning& warning);

/// Share of the occupied voxels that are sparse if the voxels are 2^`doublings` times as large as
/// the map's; 0 in a scan without voxels. Throws ConfigError as EdgeLabeller does.
double sparseShare(const VoxelScan& scan, int doublings, const EdgeConfig& config, int threads);

/// The first of twice, four times, ... the map's voxel size with a share of sparse voxels of at
/// most kSparseLimit, rounded up to 0.05 m times a power of 2. Nothing if none up to the largest of
/// these that the parameter voxel_size allows has.
std::optional<double> denserVoxelSize(const VoxelScan& scan, const EdgeConfig& config, int threads);

/// Watches scan by scan whether the voxels are smaller than the spacing of the points.
class DensityMonitor {
 public:
  static constexpr size_t kEveryScan = std::numeric_limits<size_t>::max();

  /// `window`: the last scans that count.
  DensityMonitor(const EdgeConfig& config, int threads, size_t window);

  /// `count` is what EdgeExtractor::extract() gave for the scan. A scan too sparse is counted again
  /// in larger voxels, at most every three seconds of stamps.
  void add(const VoxelScan& scan, const EdgeCount& count);

  /// Median over the window; NaN if there was no scan.
  double share() const;
  /// A warning if the median is above kSparseLimit.
  std::optional<DensityWarning> warning() const;

 private:
  bool isDue(double stamp);

  EdgeConfig config_;
  int threads_;
  RingBuffer<double> shares_;
  RingBuffer<double> voxel_sizes_;  ///< that the sparse scans need [m], infinite: none will do
  std::optional<double> counted_;   ///< stamp of the last scan counted again [s]
};

}  // namespace edgevox
