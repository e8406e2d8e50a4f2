// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/recent_edges.hpp"

#include <algorithm>
#include <iterator>

#include "dilate.hpp"

namespace edgevox {
namespace {

constexpr int kNeighbours = 5;  // a window is thinner than the map, and so are its bands of edges

/// A window has the gaps of scans, but thick walls as the map.
EdgeLabeller<16> windowLabeller(const EdgeConfig& config, int threads) {
  EdgeConfig of_window = config;
  of_window.ratio = config.map_ratio;
  return {of_window, config.scan_support, threads};
}

std::vector<VoxelIndex> voxelsOf(const BitGrid<16>& grid) {
  std::vector<VoxelIndex> voxels;
  grid.forEach([&](const VoxelIndex& v) { voxels.push_back(v); });
  return voxels;
}

}  // namespace

RecentEdges::RecentEdges(double voxel_size, const EdgeConfig& config, int scans, int threads)
    : voxel_size_(voxel_size),
      labeller_(windowLabeller(config, threads)),
      neighbours_(config.mode == EdgeMode::kPaper ? 0 : kNeighbours),
      window_(static_cast<size_t>(scans)) {}

void RecentEdges::add(const std::vector<Eigen::Vector3d>& centroids) {
  before_.push_back(voxelsOf(occupied_));
  if (before_.size() >= window_) before_.pop_front();
  const double limit = (kIndexLimit - 1) * voxel_size_;
  centroids_.clear();
  std::copy_if(centroids.begin(), centroids.end(), std::back_inserter(centroids_),
               [limit](const Eigen::Vector3d& c) { return (c.array().abs() < limit).all(); });
  occupied_.clear();
  for (const Eigen::Vector3d& c : centroids_) occupied_.set(voxelAt(c, 1.0 / voxel_size_));
}

void RecentEdges::clear() {
  before_.clear();
  centroids_.clear();
  occupied_.clear();
}

BitGrid<16> RecentEdges::edgeVoxels() const {
  BitGrid<16> occupied = occupied_;
  for (const auto& scan : before_) {
    for (const VoxelIndex& v : scan) occupied.set(v);
  }
  BitGrid<16> targets;
  Dilation<16>(1, occupied, targets).add(occupied_);
  BitGrid<16> candidates;
  labeller_.label(occupied, targets, candidates);
  BitGrid<16> edges;
  thinEdges(candidates, occupied_, neighbours_, edges);
  return edges;
}

std::vector<Eigen::Vector3f> RecentEdges::edgeCentroids() const {
  const BitGrid<16> edges = edgeVoxels();
  std::vector<Eigen::Vector3f> centroids;
  for (const Eigen::Vector3d& c : centroids_) {
    if (edges.test(voxelAt(c, 1.0 / voxel_size_))) centroids.push_back(c.cast<float>());
  }
  return centroids;
}

}  // namespace edgevox
