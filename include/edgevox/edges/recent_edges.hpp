// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "edgevox/config.hpp"
#include "edgevox/edges/edge_extractor.hpp"
#include "edgevox/grid/block_grid.hpp"
#include "edgevox/grid/voxel.hpp"
#include "edgevox/ring_buffer.hpp"

namespace edgevox {

/// The edges of the last scan by the occupancy of it and a few before it, all in the map frame.
/// Between the lines of one scan of a sparse lidar lie gaps; the lines of the scans before fill
/// them. Unlike the map, a window knows a place at once and forgets what has moved.
class RecentEdges {
 public:
  /// `scans` in the window, the last one among them. Throws ConfigError as EdgeLabeller does.
  RecentEdges(double voxel_size, const EdgeConfig& config, int scans, int threads);

  /// One scan's centroids, map frame [m]; those out of the grid's range are ignored.
  void add(std::vector<Eigen::Vector3d> centroids);
  void clear() { scans_.clear(); }

  /// Voxels of the last scan.
  BitGrid<16> occupied() const;
  /// Voxels of the last scan that are edges.
  BitGrid<16> edgeVoxels() const;
  /// Centroids of the last scan in its edge voxels, in the order of the scan, map frame [m].
  std::vector<Eigen::Vector3f> edgeCentroids() const;

 private:
  void setVoxels(const std::vector<Eigen::Vector3d>& centroids, BitGrid<16>& voxels) const;

  double voxel_size_;
  EdgeLabeller<16> labeller_;
  int neighbours_;                                  // see thinEdges()
  RingBuffer<std::vector<Eigen::Vector3d>> scans_;  // their centroids
};

}  // namespace edgevox
