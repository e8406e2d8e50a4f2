// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/map/surface_level.hpp"

#include <limits>

namespace edgevox {
namespace {

float squaredDistance(const Surface& surface, const Eigen::Vector3f& point) {
  const Eigen::Vector3f e = point - surface.mean;
  const auto& w = surface.information;
  return e.x() * (w[0] * e.x() + 2 * (w[3] * e.y() + w[5] * e.z())) +
         e.y() * (w[1] * e.y() + 2 * w[4] * e.z()) + e.z() * w[2] * e.z();
}

}  // namespace

SurfaceLevel::Around SurfaceLevel::around(const VoxelIndex& voxel, bool all) const {
  static constexpr int kOffsets[7][3] = {{0, 0, 0},  {1, 0, 0}, {-1, 0, 0}, {0, 1, 0},
                                         {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  Around around;
  around.voxel = voxel;
  const VoxelIndex home = Grid::Layout::block(voxel);
  const int32_t home_block = grid_.findBlock(home);
  for (const auto& offset : kOffsets) {
    const VoxelIndex v{voxel.x + offset[0], voxel.y + offset[1], voxel.z + offset[2]};
    const VoxelIndex its_block = Grid::Layout::block(v);
    const int32_t found = its_block == home ? home_block : grid_.findBlock(its_block);
    if (found == BlockTable::kNone) continue;
    const auto block = static_cast<size_t>(found);
    const auto& bits = all ? grid_.block(block).occupied : selected_[block];
    const int cell = Grid::Layout::cell(v);
    if (bits.test(cell)) around.slots[around.count++] = grid_.block(block).slotOf(cell);
  }
  return around;
}

const Surface* SurfaceLevel::nearest(const Around& around, const Eigen::Vector3f& point,
                                     const Eigen::Vector3f& to_sensor, float& distance) const {
  const Surface* best = nullptr;
  distance = std::numeric_limits<float>::infinity();
  for (uint32_t i = 0; i < around.count; ++i) {
    const Surface* candidate = &surfaces_[around.slots[i]];
    if (candidate->facesAway(to_sensor)) {
      if (candidate->back_surface == kNone) continue;
      candidate = &surfaces_[candidate->back_surface];
    }
    const float d = squaredDistance(*candidate, point);
    if (d < distance) {
      distance = d;
      best = candidate;
    }
  }
  return best;
}

uint32_t SurfaceLevel::takeSlot(Slots::Kind kind) {
  const uint32_t slot = slots_.take(kind);
  surfaces_.hold(slot) = {};
  return slot;
}

void SurfaceLevel::giveBack(uint32_t slot) {
  surfaces_.edit(slot) = {};
  slots_.giveBack(slot);
  slots_.dropIfFree(slot, surfaces_);
}

uint32_t SurfaceLevel::insert(const VoxelIndex& v) {
  const uint32_t next = slots_.next(Slots::kNear);
  const uint32_t slot = grid_.insert(v, next);
  if (slot == next) takeSlot(Slots::kNear);
  while (selected_.size() < grid_.blockCount()) selected_.grow();
  return slot;
}

uint32_t SurfaceLevel::insertBack(uint32_t slot) {
  const uint32_t back = takeSlot(Slots::kNear);
  surfaces_.edit(slot).back_surface = back;
  return back;
}

void SurfaceLevel::erase(const VoxelIndex& v) {
  setSelected(v, false);
  for (uint32_t slot = slotOf(v); slot != kNone;) {
    const uint32_t next = surfaces_[slot].back_surface;
    giveBack(slot);
    slot = next;
  }
  grid_.erase(v);
}

bool SurfaceLevel::isSelected(const VoxelIndex& v) const {
  const int32_t block = grid_.findBlock(Grid::Layout::block(v));
  return block != BlockTable::kNone &&
         selected_[static_cast<size_t>(block)].test(Grid::Layout::cell(v));
}

void SurfaceLevel::move(const VoxelIndex& v, Slots::Kind to) {
  uint32_t before = kNone;  // slot of the surface that leads to the next
  for (uint32_t from = slotOf(v); from != kNone;) {
    const Surface surface = surfaces_[from];
    const uint32_t slot = takeSlot(to);
    surfaces_.edit(slot) = surface;
    giveBack(from);
    if (before == kNone) {
      grid_.setSlot(v, slot);
    } else {
      surfaces_.edit(before).back_surface = slot;
    }
    before = slot;
    from = surface.back_surface;
  }
}

void SurfaceLevel::shrinkBlock(const VoxelIndex& block) {
  const int32_t found = grid_.findBlock(block);
  if (found != BlockTable::kNone) grid_.shrinkBlock(static_cast<size_t>(found));
}

void SurfaceLevel::setSelected(const VoxelIndex& v, bool selected) {
  const size_t block = blockOf(v);
  const int cell = Grid::Layout::cell(v);
  if (selected_[block].test(cell) == selected) return;
  selected_.edit(block).flip(cell);
  selected ? ++selected_count_ : --selected_count_;
}

void SurfaceLevel::checkRead() {
  const auto fail = [] { throw ArchiveError("the surfaces do not fit to their voxels"); };
  if (selected_.size() != grid_.blockCount()) fail();
  selected_count_ = 0;
  for (size_t block = 0; block < selected_.size(); ++block) {
    if (!selected_[block].isSubsetOf(grid_.block(block).occupied)) fail();
    selected_count_ += selected_[block].count();
  }
  slots_.checkRead(slotsInUse());
}

/// Throws ArchiveError if a slot has no surface or is in use twice.
std::vector<bool> SurfaceLevel::slotsInUse() const {
  std::vector<bool> used(slots_.end());
  forEachVoxel([&](const VoxelIndex&, uint32_t first) {
    for (uint32_t slot = first; slot != kNone; slot = surfaces_[slot].back_surface) {
      if (slot >= slots_.end() || !surfaces_.holds(slot) || used[slot]) {
        throw ArchiveError("a voxel has no surface of its own");
      }
      used[slot] = true;
      if (slot != first && (hasBack(slot) || slots_.kindOf(slot) != slots_.kindOf(first))) {
        throw ArchiveError("a surface has a wrong back");
      }
    }
  });
  return used;
}

size_t SurfaceLevel::bytes() const {
  return grid_.bytes() + selected_.bytes() + surfaces_.bytes() + slots_.bytes();
}

size_t SurfaceLevel::freeBytes() const {
  const size_t surfaces = slots_.freeCount(Slots::kNear) + slots_.freeCount(Slots::kFar);
  return grid_.freeBytes() + surfaces * sizeof(Surface);
}

}  // namespace edgevox
