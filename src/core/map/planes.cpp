// SPDX-License-Identifier: BSD-3-Clause
// Planes follow from the moments of level 1.
#include <vector>

#include "core/map/block_planes.hpp"
#include "core/sort_unique.hpp"
#include "edgevox/map/map_builder.hpp"

namespace edgevox {

void MapBuilder::fitPlanes() {
  if (config_.representation == Representation::kEdges) return;
  std::vector<VoxelIndex> blocks;
  for (const VoxelIndex& v : scan_.voxels) {
    const VoxelIndex block = coarser(v, MatchMap::kCoarsestPlanes);
    if (blocks.empty() || blocks.back() != block) blocks.push_back(block);
  }
  for (const VoxelIndex& v : scan_.cleared) {
    blocks.push_back(coarser(v, MatchMap::kCoarsestPlanes));
    for (int l = MatchMap::kFinestPlanes; l <= MatchMap::kCoarsestPlanes; ++l) {
      match_map_.planes(l).set(coarser(v, l), {});  // its points left the map, not its memory
    }
  }
  sortUnique(blocks);
  for (const VoxelIndex& block : blocks) fitPlanes(block);
}

void MapBuilder::fitPlanes(const VoxelIndex& block) {
  const SurfaceLevel& surfaces = match_map_.surfaces();
  const Eigen::Vector3d centre = voxelCentre(block, voxelSize(MatchMap::kCoarsestPlanes));
  std::vector<VoxelSide> sides;
  std::vector<uint32_t> slots;
  surfaces.forEachVoxelInBlock(block, [&](const VoxelIndex& v, uint32_t first) {
    for (uint32_t slot = first; slot != Surface::kNone;
         slot = surfaces.surface(slot).back_surface) {
      const MomentCell& cell = moments_.cell(slot);
      if (cell.count == 0) continue;
      slots.push_back(first);
      sides.push_back({v,
                       moments_.moments(slot).about(centre - voxelCentre(v, voxelSize(1))),
                       {cell.view[0], cell.view[1], cell.view[2]}});
    }
  });
  const BlockPlanes planes(block, sides, voxelSize(1), match_map_);
  planes.forEachVoxel([this](int l, const VoxelIndex& v, const VoxelPlanes& of_voxel) {
    match_map_.planes(l).set(v, of_voxel);
  });
  for (size_t i = 0; i < sides.size();) {
    const uint32_t slot = slots[i];
    bool explained = true;
    for (; i < sides.size() && slots[i] == slot; ++i) {
      explained = explained && planes.explains(sides[i]);
    }
    if (moments_.cell(slot).explained == explained) continue;
    moments_.editCell(slot).explained = explained;
    touch(slot);
  }
}

}  // namespace edgevox
