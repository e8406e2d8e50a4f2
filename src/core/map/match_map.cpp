// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/map/match_map.hpp"

#include <algorithm>
#include <cmath>

namespace edgevox {
namespace {

int levelCount(double voxel_size, double coarsest_voxel) {
  const int coarsest = static_cast<int>(std::lround(std::log2(coarsest_voxel / voxel_size)));
  return std::max(coarsest, MatchMap::kCoarsestPlanes) + 1;
}

}  // namespace

MatchMap::MatchMap(double voxel_size, double coarsest_voxel)
    : voxel_size_(voxel_size),
      occupied_(static_cast<size_t>(levelCount(voxel_size, coarsest_voxel))),
      surfaces_(voxelSize(1)) {
  for (int l = kFinestPlanes; l <= kCoarsestPlanes; ++l) planes_.emplace_back(voxelSize(l));
}

size_t MatchMap::bytes() const {
  size_t bytes = edge_voxels_.bytes() + hit_voxels_.bytes() +
                 edges_.capacity() * sizeof(EdgeVoxel) +
                 beside_edges_.capacity() * sizeof(VoxelPoint) + surfaces_.bytes();
  for (const BitGrid<8>& bits : occupied_) bytes += bits.bytes();
  for (const PlaneLevel& level : planes_) bytes += level.bytes();
  return bytes;
}

size_t MatchMap::freeBytes() const {
  size_t bytes = surfaces_.freeBytes() + hit_voxels_.freeBytes();
  for (const PlaneLevel& level : planes_) bytes += level.freeBytes();
  return bytes;
}

}  // namespace edgevox
