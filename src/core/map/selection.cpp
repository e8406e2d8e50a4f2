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

void MapBuilder::selectNew(uint32_t slot) {
  const double lot = unitHash(moments_.voxel(slot));
  if (config_.representation == Representation::kAll) select(slot, true);
  if (config_.representation == Representation::kSparse) {
    moments_.editCell(slot).anchor = lot < kNewShare;
    select(slot, lot < kNewShare);
  }
  if (config_.representation == Representation::kRandom) select(slot, lot < random_share_);
}

void MapBuilder::touch(uint32_t slot) {
  if (config_.representation != Representation::kAll) touched_.push_back(slot);
}

void MapBuilder::chooseAnchorsAnew() {
  const SurfaceLevel& surfaces = match_map_.surfaces();
  sortUnique(touched_);
  std::vector<size_t> blocks(touched_.size());
  for (size_t i = 0; i < touched_.size(); ++i) {
    const uint32_t slot = touched_[i];
    blocks[i] = kNoBlock;
    if (!moments_.hasCell(slot)) continue;
    if (moments_.cell(slot).hits >= config_.min_hits) moments_.findFlatAxis(slot);
    blocks[i] = surfaces.blockOf(moments_.voxel(slot));
  }
  touched_.clear();
  sortUnique(blocks);
  if (!blocks.empty() && blocks.back() == kNoBlock) blocks.pop_back();
  for (const size_t block : blocks) {
    chooseAnchors(moments_, surfaces, block, {config_.anchors, config_.min_hits});
    if (config_.representation != Representation::kSparse) continue;
    surfaces.forEachInBlock(block,
                            [this](uint32_t slot) { select(slot, moments_.cell(slot).anchor); });
  }
}

void MapBuilder::selectRandom() {
  size_t anchors = 0;
  size_t candidates = 0;
  for (uint32_t slot = 0; slot < moments_.size(); ++slot) {
    if (!moments_.hasCell(slot) || moments_.cell(slot).is_back) continue;
    anchors += moments_.cell(slot).anchor ? 1 : 0;
    candidates += moments_.cell(slot).hits >= config_.min_hits ? 1 : 0;
  }
  random_share_ = static_cast<double>(anchors) / static_cast<double>(candidates);
  for (uint32_t slot = 0; slot < moments_.size(); ++slot) {
    if (!moments_.hasCell(slot) || moments_.cell(slot).is_back) continue;
    const double lot = unitHash(moments_.voxel(slot));
    select(slot, moments_.cell(slot).hits >= config_.min_hits && lot < random_share_);
  }
}

/// Chooses anew among the voxels that were hit, or that hold edges or no longer do, since the last
/// choice.
void MapBuilder::selectEdges() {
  sortUnique(touched_);
  for (const uint32_t slot : touched_) {
    if (!moments_.hasCell(slot) || moments_.cell(slot).is_back) continue;
    select(slot, moments_.cell(slot).edge_children > 0);
  }
  touched_.clear();
}

}  // namespace edgevox
