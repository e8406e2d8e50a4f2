// SPDX-License-Identifier: BSD-3-Clause
// What the map says of edge voxels.
#include <algorithm>

#include "core/map/voxel_tree.hpp"
#include "core/sort_unique.hpp"
#include "edgevox/edges/edge_direction.hpp"
#include "edgevox/map/map_builder.hpp"

namespace edgevox {

/// Chooses anew among the voxels that were hit, or that hold edges or no longer do, since the last
/// choice.
void MapBuilder::selectEdges() {
  for (int l = 1; l <= MatchMap::kSurfaceLevels; ++l) {
    auto& slots = touched_[static_cast<size_t>(l - 1)];
    sortUnique(slots);
    for (const uint32_t slot : slots) {
      if (!moments(l).hasCell(slot) || moments(l).cell(slot).is_back) continue;
      select(l, slot, moments(l).cell(slot).edge_children > 0);
    }
    slots.clear();
  }
}

MatchMap MapBuilder::completeMap() const {
  MatchMap map = match_map_;
  map.hitVoxels() = hitVoxels();
  const std::vector<VoxelIndex> voxels = inTreeOrder(edgeVoxels());
  const std::vector<Eigen::Vector3f> directions = edgeDirections(map.hitVoxels(), voxels);
  for (size_t i = 0; i < voxels.size(); ++i) {
    map.edges().push_back({voxels[i], centroid(voxels[i]).cast<float>(), directions[i]});
  }
  if (config_.representation != Representation::kEdges) return map;
  for (const VoxelIndex& v : besideEdges(map.hitVoxels(), edgeVoxels())) {
    map.besideEdges().push_back({v, centroid(v).cast<float>()});
  }
  return map;
}

}  // namespace edgevox
