// SPDX-License-Identifier: BSD-3-Clause
#include "support/scans.hpp"

namespace edgevox::test {

using Eigen::Vector3d;

std::vector<Centroids> randomScans(uint32_t seed, int count, const Vector3d& room) {
  Random random(seed);
  const Scene scene = roomScene(random, room, 0.2);
  std::vector<Centroids> scans(static_cast<size_t>(count));
  for (Centroids& scan : scans) {
    const Vector3d middle = random.vectorIn(-15, 15);
    for (const Vector3d& point : scene.points) {
      const bool in_reach = (point - middle).norm() < room.x() / 2;
      if (in_reach && random.chance(0.3)) scan.push_back(point * kScanMapVoxel);
    }
  }
  return scans;
}

AccumulatedCells accumulate(const std::vector<Centroids>& scans, int level) {
  AccumulatedCells cells;
  for (size_t scan = 0; scan < scans.size(); ++scan) {
    for (const Vector3d& centroid : scans[scan]) {
      AccumulatedCell& cell = cells[coarser(voxelAt(centroid, 1.0 / kScanMapVoxel), level)];
      cell.centroids.push_back(centroid);
      if (cell.last_scan != static_cast<int>(scan)) ++cell.hits;
      cell.last_scan = static_cast<int>(scan);
    }
  }
  return cells;
}

Voxels withHits(const AccumulatedCells& cells, int min_hits) {
  Voxels voxels;
  for (const auto& [v, cell] : cells) {
    if (cell.hits >= min_hits) voxels.push_back(v);
  }
  return voxels;
}

}  // namespace edgevox::test
