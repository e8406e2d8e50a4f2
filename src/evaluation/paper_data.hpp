// SPDX-License-Identifier: BSD-3-Clause
// What a recording is like: Tables I and II and Fig. 4 of Ryde, Delmerico, Corso 2013.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "edgevox/grid/block_grid.hpp"
#include "evaluation/paper_run.hpp"

namespace edgevox {

/// The eigenvalues, ascending, of the structure tensor as published (eq. 5-7 with h = 2) at each of
/// the voxels.
std::vector<Eigen::Vector3d> publishedEigenvalues(const BitGrid<16>& occupied,
                                                  const std::vector<VoxelIndex>& voxels);

struct ExtractionTime {
  int threads = 1;
  double milliseconds = 0.0;  ///< wall time of the largest scan, the least of several
};

struct PaperData {
  static constexpr size_t kBins = 50;

  size_t scans = 0;
  double points = 0.0;  ///< a scan, mean; the same of the next three
  double voxels = 0.0;
  double edges = 0.0;
  double merged_leaves = 0.0;  ///< of an octree in which eight full leaves are one
  double compression = 0.0;    ///< voxels / edges of a scan, mean
  size_t map_voxels = 0;       ///< of the union of all scans at their true poses
  size_t map_edges = 0;        ///< of the union of the edges of all scans
  size_t map_merged_leaves = 0;
  Eigen::Vector3d extent = Eigen::Vector3d::Zero();  ///< of the map [m]
  /// Of all voxels, by the ratio of the middle to the largest eigenvalue, from 0 to 1.
  std::array<size_t, kBins> ratios{};
  std::vector<ExtractionTime> extraction;
};

/// Throws std::invalid_argument if there are no scans with poses.
PaperData measureData(const ScanStream& scans, const PaperOptions& options);

}  // namespace edgevox
