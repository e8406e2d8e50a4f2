// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/recent_edges.hpp"

#include <algorithm>
#include <utility>

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

/// Repeats that follow one another are left out.
std::vector<VoxelIndex> voxelsOf(const std::vector<Eigen::Vector3d>& centroids, double size) {
  std::vector<VoxelIndex> voxels;
  voxels.reserve(centroids.size());
  for (const Eigen::Vector3d& c : centroids) {
    const VoxelIndex v = voxelAt(c, 1.0 / size);
    if (voxels.empty() || v != voxels.back()) voxels.push_back(v);
  }
  return voxels;
}

}  // namespace

RecentEdges::RecentEdges(double voxel_size, const EdgeConfig& config, int scans, int threads)
    : voxel_size_(voxel_size),
      labeller_(windowLabeller(config, threads)),
      neighbours_(config.mode == EdgeMode::kPaper ? 0 : kNeighbours),
      window_(static_cast<size_t>(scans)) {}

void RecentEdges::add(std::vector<Eigen::Vector3d> centroids) {
  const double limit = (kIndexLimit - 1) * voxel_size_;
  const auto is_outside = [limit](const Eigen::Vector3d& c) {
    return !(c.array().abs() < limit).all();
  };
  centroids.erase(std::remove_if(centroids.begin(), centroids.end(), is_outside), centroids.end());
  centroids_ = std::move(centroids);
  scans_.push_back(voxelsOf(centroids_, voxel_size_));
  if (scans_.size() > window_) scans_.pop_front();
}

void RecentEdges::clear() {
  scans_.clear();
  centroids_.clear();
}

BitGrid<16> RecentEdges::occupied() const {
  BitGrid<16> occupied;
  if (scans_.empty()) return occupied;
  for (const VoxelIndex& v : scans_.back()) occupied.set(v);
  return occupied;
}

BitGrid<16> RecentEdges::edgeVoxels() const {
  const BitGrid<16> last = occupied();
  BitGrid<16> window;
  for (const auto& scan : scans_) {
    for (const VoxelIndex& v : scan) window.set(v);
  }
  BitGrid<16> targets;
  Dilation<16>(1, window, targets).add(last);
  BitGrid<16> candidates;
  labeller_.label(window, targets, candidates);
  BitGrid<16> edges;
  thinEdges(candidates, last, neighbours_, edges);
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
