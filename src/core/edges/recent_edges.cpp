// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/edges/recent_edges.hpp"

#include <utility>

#include "core/grid/dilate.hpp"

namespace edgevox {
namespace {

constexpr int kNeighbours = 5;  // a window is thinner than the map, and so are its bands of edges

}  // namespace

// A window has thick walls as the map, but the gaps of scans.
RecentEdges::RecentEdges(double voxel_size, const EdgeConfig& config, int scans, int threads)
    : voxel_size_(voxel_size),
      labeller_(config, {config.map.ratio, config.scan.support}, threads),
      neighbours_(config.mode == EdgeMode::kPaper ? 0 : kNeighbours),
      scans_(static_cast<size_t>(scans)) {}

void RecentEdges::add(std::vector<Eigen::Vector3d> centroids) { scans_.push(std::move(centroids)); }

void RecentEdges::setVoxels(const std::vector<Eigen::Vector3d>& centroids,
                            BitGrid<16>& voxels) const {
  for (const Eigen::Vector3d& c : centroids) {
    if (inGridRange(c, voxel_size_)) voxels.set(voxelAt(c, 1.0 / voxel_size_));
  }
}

BitGrid<16> RecentEdges::occupied() const {
  BitGrid<16> occupied;
  if (!scans_.empty()) setVoxels(scans_.newest(), occupied);
  return occupied;
}

BitGrid<16> RecentEdges::edgeVoxels() const {
  const BitGrid<16> last = occupied();
  BitGrid<16> window;
  for (size_t i = 0; i < scans_.size(); ++i) setVoxels(scans_[i], window);
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
  if (scans_.empty()) return centroids;
  for (const Eigen::Vector3d& c : scans_.newest()) {
    const bool edge = inGridRange(c, voxel_size_) && edges.test(voxelAt(c, 1.0 / voxel_size_));
    if (edge) centroids.push_back(c.cast<float>());
  }
  return centroids;
}

}  // namespace edgevox
