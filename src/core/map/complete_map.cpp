// SPDX-License-Identifier: BSD-3-Clause
// The map as it is saved.
#include <algorithm>

#include "core/map/voxel_tree.hpp"
#include "edgevox/edges/edge_direction.hpp"
#include "edgevox/map/map_builder.hpp"

namespace edgevox {

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
