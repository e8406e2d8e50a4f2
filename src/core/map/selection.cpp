// SPDX-License-Identifier: BSD-3-Clause
// Which voxels scans are matched to.
#include <algorithm>

#include "core/sort_unique.hpp"
#include "edgevox/map/map_builder.hpp"

namespace edgevox {
namespace {

constexpr size_t kNoBlock = static_cast<size_t>(BlockTable::kNone);  // what was there is gone
constexpr double kNewShare = 0.25;  // of the voxels that came since the last choice of anchors

}  // namespace

void MapBuilder::selectNew(int l, uint32_t slot) {
  MomentLevel& level = momentLevel(l);
  if (config_.representation == Representation::kAll) select(l, slot, true);
  if (config_.representation == Representation::kSparse) {
    level.editCell(slot).anchor = unitHash(level.voxel(slot)) < kNewShare;
    select(l, slot, level.cell(slot).anchor);
  }
  if (config_.representation == Representation::kRandom) {
    select(l, slot, unitHash(level.voxel(slot)) < random_share_[static_cast<size_t>(l - 1)]);
  }
}

void MapBuilder::touch(int l, uint32_t slot) {
  if (config_.representation == Representation::kAll) return;
  touched_[static_cast<size_t>(l - 1)].push_back(slot);
}

void MapBuilder::chooseAnchorsAnew() {
  for (int l = 1; l <= MatchMap::kSurfaceLevels; ++l) {
    MomentLevel& level = momentLevel(l);
    const SurfaceLevel& surfaces = match_map_.surfaces(l);
    auto& slots = touched_[static_cast<size_t>(l - 1)];
    sortUnique(slots);
    std::vector<size_t> blocks(slots.size());
    for (size_t i = 0; i < slots.size(); ++i) {
      blocks[i] = kNoBlock;
      if (!level.hasCell(slots[i])) continue;
      if (level.cell(slots[i]).hits >= config_.min_hits) level.findFlatAxis(slots[i]);
      blocks[i] = surfaces.blockOf(level.voxel(slots[i]));
    }
    slots.clear();
    sortUnique(blocks);
    if (!blocks.empty() && blocks.back() == kNoBlock) blocks.pop_back();
    for (const size_t block : blocks) {
      chooseAnchors(level, surfaces, block, {config_.anchors, config_.min_hits});
      if (config_.representation != Representation::kSparse) continue;
      surfaces.forEachInBlock(block,
                              [&](uint32_t slot) { select(l, slot, level.cell(slot).anchor); });
    }
  }
}

void MapBuilder::selectRandom() {
  for (int l = 1; l <= MatchMap::kSurfaceLevels; ++l) {
    const MomentLevel& level = moments(l);
    size_t anchors = 0;
    size_t candidates = 0;
    for (uint32_t slot = 0; slot < level.size(); ++slot) {
      if (!level.hasCell(slot) || level.cell(slot).is_back) continue;
      anchors += level.cell(slot).anchor ? 1 : 0;
      candidates += level.cell(slot).hits >= config_.min_hits ? 1 : 0;
    }
    double& share = random_share_[static_cast<size_t>(l - 1)];
    share = static_cast<double>(anchors) / static_cast<double>(candidates);
    for (uint32_t slot = 0; slot < level.size(); ++slot) {
      if (!level.hasCell(slot)) continue;
      const MomentLevel::Cell& cell = level.cell(slot);
      if (cell.is_back) continue;
      select(l, slot, cell.hits >= config_.min_hits && unitHash(level.voxel(slot)) < share);
    }
  }
}

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

}  // namespace edgevox
