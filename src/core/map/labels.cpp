// SPDX-License-Identifier: BSD-3-Clause
// Edges by the accumulated occupancy.
#include "core/grid/dilate.hpp"
#include "core/map/edge_children.hpp"
#include "edgevox/map/map_builder.hpp"

namespace edgevox {

bool MapBuilder::labelDue() const {
  return config_.representation != Representation::kAll &&
         scans_ % static_cast<uint32_t>(config_.label_every) == 0;
}

void MapBuilder::label() {
  BitGrid<16> relabelled;
  Dilation<16>(labeller_.reach(), match_map_.hitVoxels(), relabelled).add(changed_);
  changed_.clear();
  labeller_.label(match_map_.hitVoxels(), relabelled, edge_candidates_);
  BitGrid<16> targets;
  Dilation<16>(1, match_map_.hitVoxels(), targets).add(relabelled);
  BitGrid<16>& edges = match_map_.edgeVoxels();
  std::vector<BitGrid<16>::Block> before(targets.blockCount());
  for (size_t slot = 0; slot < before.size(); ++slot) {
    const auto* known = edges.findBlock(targets.blockIndex(slot));
    before[slot] = known == nullptr ? BitGrid<16>::Block{} : *known;
  }
  thinEdges(edge_candidates_, targets, edge_neighbours_, edges);
  changeEdges(targets, before);
  if (config_.representation == Representation::kEdges) return selectEdges();
  chooseAnchorsAnew();
  if (config_.representation == Representation::kRandom) selectRandom();
}

void MapBuilder::changeEdges(const BitGrid<16>& targets,
                             const std::vector<BitGrid<16>::Block>& before) {
  for (size_t slot = 0; slot < before.size(); ++slot) {
    const VoxelIndex& block = targets.blockIndex(slot);
    const auto* now = edgeVoxels().findBlock(block);
    if (now == nullptr) continue;
    BitGrid<16>::Block differs;
    for (size_t row = 0; row < now->size(); ++row) {
      differs[row] = static_cast<uint16_t>((*now)[row] ^ before[slot][row]);
    }
    BitGrid<16>::forEachInBlock(block, differs,
                                [&](const VoxelIndex& v) { countEdges(coarser(v, 1)); });
  }
}

void MapBuilder::countEdges(const VoxelIndex& parent) {
  const uint32_t slot = match_map_.surfaces().slotOf(parent);
  if (slot == SurfaceLevel::kNone) return;  // thawed and not hit again
  const uint8_t before = moments_.cell(slot).edge_children;
  const uint8_t now = edgeChildrenOf(edgeVoxels(), parent);
  if (now != before) moments_.editCell(slot).edge_children = now;
  if ((now != 0) != (before != 0)) touch(slot);
}

}  // namespace edgevox
