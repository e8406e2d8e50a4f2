// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "edgevox/grid/block_grid.hpp"
#include "edgevox/grid/voxel.hpp"
#include "edgevox/map/plane_level.hpp"
#include "edgevox/map/surface_level.hpp"

namespace edgevox {

/// A voxel of the finest size on a geometric edge.
struct EdgeVoxel {
  VoxelIndex voxel;
  Eigen::Vector3f centroid;   ///< of the points in it [m]
  Eigen::Vector3f direction;  ///< along the edge, see edgeDirections()
};

/// A voxel of the finest size and the centroid of the points in it [m].
struct VoxelPoint {
  VoxelIndex voxel;
  Eigen::Vector3f centroid;
};

/// What scans are matched to, a value: a multi-resolution occupied voxel list (Ryde and Hu 2010).
/// Level k has voxels of voxel_size * 2^k. All levels from 1 on hold the bits of all occupied
/// voxels, for the search; level 1 holds surfaces and levels kFinestPlanes to kCoarsestPlanes hold
/// planes, for the refinement; level 0 holds the edge voxels of the accumulated occupancy.
class MatchMap {
 public:
  static constexpr int kFinestPlanes = 2;
  static constexpr int kCoarsestPlanes = 4;

  /// An empty map; both sizes in metres, `coarsest_voxel` fixes the number of levels.
  MatchMap(double voxel_size, double coarsest_voxel);

  int levels() const { return static_cast<int>(occupied_.size()); }
  double voxelSize(int level) const { return voxel_size_ * static_cast<double>(1 << level); }

  /// The bits of a level; 1 <= level < levels().
  const BitGrid<8>& occupied(int level) const { return occupied_[static_cast<size_t>(level)]; }
  BitGrid<8>& occupied(int level) { return occupied_[static_cast<size_t>(level)]; }
  /// The surfaces of level 1.
  const SurfaceLevel& surfaces() const { return surfaces_; }
  SurfaceLevel& surfaces() { return surfaces_; }
  /// The planes of a level; kFinestPlanes <= level <= kCoarsestPlanes.
  const PlaneLevel& planes(int level) const {
    return planes_[static_cast<size_t>(level - kFinestPlanes)];
  }
  PlaneLevel& planes(int level) { return planes_[static_cast<size_t>(level - kFinestPlanes)]; }
  const BitGrid<16>& edgeVoxels() const { return edge_voxels_; }
  BitGrid<16>& edgeVoxels() { return edge_voxels_; }
  /// The edge voxels as they are saved, in the order of an octree; none while mapping goes on.
  const std::vector<EdgeVoxel>& edges() const { return edges_; }
  std::vector<EdgeVoxel>& edges() { return edges_; }
  /// With the representation `edges` the voxels that share one of level 1 with an edge, saved and
  /// in order as these: together they tell the surfaces.
  const std::vector<VoxelPoint>& besideEdges() const { return beside_edges_; }
  std::vector<VoxelPoint>& besideEdges() { return beside_edges_; }
  /// All occupied voxels of level 0; while mapping goes on those in places that are not frozen.
  const BitGrid<16>& hitVoxels() const { return hit_voxels_; }
  BitGrid<16>& hitVoxels() { return hit_voxels_; }

  /// Size of what is held in memory.
  size_t bytes() const;
  /// The part of bytes() that is free and will be used again.
  size_t freeBytes() const;

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    for (int l = 1; l < self.levels(); ++l) bytes(self.occupied(l));
    bytes(self.surfaces_);
    for (auto& level : self.planes_) bytes(level);
    bytes(self.edge_voxels_);
  }

 private:
  double voxel_size_;
  std::vector<BitGrid<8>> occupied_;  // [0] is not used
  SurfaceLevel surfaces_;
  std::vector<PlaneLevel> planes_;
  BitGrid<16> edge_voxels_;
  BitGrid<16> hit_voxels_;
  std::vector<EdgeVoxel> edges_;
  std::vector<VoxelPoint> beside_edges_;
};

}  // namespace edgevox
