// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/map/moment_level.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace edgevox {
uint32_t MomentLevel::slotFor(const VoxelIndex& v, SurfaceLevel& surfaces) {
  const uint32_t slot = surfaces.insert(v);
  if (!hasCell(slot) || cells_[slot].count == 0) makeCell(slot, v);
  return slot;
}

void MomentLevel::makeCell(uint32_t slot, const VoxelIndex& v) {
  cells_.hold(slot);
  voxels_.hold(slot) = v;
}

/// The cell of the surface in the voxel that `to_sensor` sees.
uint32_t MomentLevel::sideSlot(uint32_t slot, const Eigen::Vector3f& to_sensor,
                               SurfaceLevel& surfaces) {
  if (!surfaces.surface(slot).facesAway(to_sensor)) return slot;
  if (!surfaces.hasBack(slot)) {
    const uint32_t back = surfaces.insertBack(slot);
    makeCell(back, voxels_[slot]);
    cells_.edit(back).is_back = true;
    cells_.edit(back).selected = cells_[slot].selected;
  }
  return surfaces.surface(slot).back_surface;
}

bool MomentLevel::add(uint32_t slot, const Eigen::Vector3d& centroid,
                      const Eigen::Vector3f& to_sensor, uint32_t scan, SurfaceLevel& surfaces) {
  const uint32_t side = sideSlot(slot, to_sensor, surfaces);
  Cell& seen = cells_.edit(side);
  const Eigen::Vector3f d = (centroid - voxelCentre(voxels_[slot], voxel_size_)).cast<float>();
  for (size_t i = 0; i < 3; ++i) {
    const auto a = static_cast<Eigen::Index>(i);
    const auto b = static_cast<Eigen::Index>((i + 1) % 3);
    seen.sum[i] += d[a];
    seen.outer[i] += d[a] * d[a];
    seen.outer[i + 3] += d[a] * d[b];
    seen.view[i] += to_sensor[a];
  }
  ++seen.count;
  setStale(side);
  if (cells_[slot].last_scan == scan) return false;
  Cell& cell = cells_.edit(slot);
  cell.last_scan = scan;
  if (cell.hits < std::numeric_limits<uint16_t>::max()) ++cell.hits;
  return true;
}

void MomentLevel::setStale(uint32_t slot) {
  if (cells_[slot].stale) return;
  cells_.edit(slot).stale = true;
  stale_.push_back(slot);
}

void MomentLevel::setMoments(uint32_t slot, const Moments& moments) {
  Cell& cell = cells_.edit(slot);
  const auto kept = static_cast<float>(moments.count / cell.count);
  for (size_t i = 0; i < 3; ++i) {
    const auto a = static_cast<Eigen::Index>(i);
    cell.sum[i] = static_cast<float>(moments.sum[a]);
    cell.outer[i] = static_cast<float>(moments.outer(a, a));
    cell.outer[i + 3] = static_cast<float>(moments.outer(a, (a + 1) % 3));
    cell.view[i] *= kept;
  }
  cell.count = static_cast<uint32_t>(moments.count);
  setStale(slot);
}

void MomentLevel::erase(const VoxelIndex& v, SurfaceLevel& surfaces) {
  const uint32_t slot = surfaces.slotOf(v);
  const uint32_t back = surfaces.surface(slot).back_surface;
  surfaces.erase(v);
  dropCell(slot, surfaces);
  if (back != Surface::kNone) dropCell(back, surfaces);
}

/// Of a slot that has been given back.
void MomentLevel::dropCell(uint32_t slot, const SurfaceLevel& surfaces) {
  if (!hasCell(slot)) return;  // it went with the chunk
  cells_.edit(slot) = {};
  surfaces.slots().dropIfFree(slot, cells_);
  surfaces.slots().dropIfFree(slot, voxels_);
}

void MomentLevel::pack(const VoxelIndex& v, SurfaceLevel& surfaces,
                       std::vector<PackedCell>& packed) {
  const uint32_t slot = surfaces.slotOf(v);
  const uint32_t back = surfaces.surface(slot).back_surface;
  surfaces.move(v, Slots::kFar);
  packed.emplace_back(cells_[slot], voxel_size_);
  if (back != Surface::kNone) packed.emplace_back(cells_[back], voxel_size_);
  dropCell(slot, surfaces);
  if (back != Surface::kNone) dropCell(back, surfaces);
}

const PackedCell* MomentLevel::unpack(const VoxelIndex& v, SurfaceLevel& surfaces,
                                      const PackedCell* packed, uint8_t edge_children) {
  surfaces.move(v, Slots::kNear);
  const uint32_t first = surfaces.slotOf(v);
  const Eigen::Vector3d centre = voxelCentre(v, voxel_size_);
  for (uint32_t slot = first; slot != Surface::kNone; slot = surfaces.surface(slot).back_surface) {
    makeCell(slot, v);
    cells_.edit(slot) =
        (packed++)->unpacked(surfaces.surface(slot).mean.cast<double>() - centre, voxel_size_);
  }
  cells_.edit(first).edge_children = edge_children;
  return packed;
}

void MomentLevel::update(uint32_t slot, Side side, SurfaceLevel& surfaces) {
  Surface& now = surfaces.editSurface(slot);
  const Surface before = now;
  const Cell& cell = cells_[slot];
  now = surfaceOf(moments(slot), voxels_[slot], voxel_size_,
                  {cell.view[0], cell.view[1], cell.view[2]});
  now.back_surface = before.back_surface;
  if (side == Side::kKeep) now.side = before.side;
  cells_.edit(slot).stale = false;
}

void MomentLevel::updateSelected(SurfaceLevel& surfaces) {
  for (const uint32_t slot : stale_) {
    if (!isStale(slot)) continue;
    if (cells_[slot].selected) {
      update(slot, Side::kRefresh, surfaces);
    } else {
      stale_unselected_.push_back(slot);
    }
  }
  stale_.clear();
  if (stale_unselected_.size() > 2 * size()) dropRepeats();
}

void MomentLevel::dropRepeats() {
  auto& slots = stale_unselected_;
  std::sort(slots.begin(), slots.end());
  slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
}

void MomentLevel::updateAll(SurfaceLevel& surfaces) {
  for (const auto* slots : {&stale_, &stale_unselected_}) {
    for (const uint32_t slot : *slots) {
      if (isStale(slot)) update(slot, Side::kKeep, surfaces);
    }
  }
  stale_.clear();
  stale_unselected_.clear();
}

void MomentLevel::select(uint32_t slot, bool selected, SurfaceLevel& surfaces) {
  if (cells_[slot].selected == selected) return;
  surfaces.setSelected(voxels_[slot], selected);
  for (uint32_t side = slot; side != Surface::kNone; side = surfaces.surface(side).back_surface) {
    cells_.edit(side).selected = selected;
    if (selected) update(side, Side::kRefresh, surfaces);
  }
}

void MomentLevel::findFlatAxis(uint32_t slot) {
  const SurfaceShape shape(moments(slot), voxel_size_);
  const int8_t axis = shape.isPatch() ? static_cast<int8_t>(shape.axis) : kNotFlat;
  if (cells_[slot].flat_axis != axis) cells_.edit(slot).flat_axis = axis;
}

Moments MomentLevel::moments(uint32_t slot) const {
  const Cell& cell = cells_[slot];
  return {static_cast<double>(cell.count),
          {cell.sum[0], cell.sum[1], cell.sum[2]},
          symmetric(cell.outer)};
}

Eigen::Vector3d MomentLevel::normal(uint32_t slot) const {
  const SurfaceShape shape(moments(slot), voxel_size_);
  return shape.flat ? shape.normal : Eigen::Vector3d::Zero();
}

void MomentLevel::checkRead(const SurfaceLevel& surfaces) const {
  const auto require = [](bool good) {
    if (!good) throw ArchiveError("the moments do not fit to their surfaces");
  };
  std::vector<bool> used(size());
  surfaces.forEachVoxel([&](const VoxelIndex& v, uint32_t first) {
    for (uint32_t slot = first; slot != Surface::kNone;
         slot = surfaces.surface(slot).back_surface) {
      const bool far = surfaces.slots().kindOf(slot) == Slots::kFar;
      require(far != hasCell(slot) && far != voxels_.holds(slot));
      if (far) continue;
      used[slot] = true;
      const Cell& cell = cells_[slot];
      require(voxels_[slot] == v && cell.is_back == (slot != first) && cell.flat_axis >= kNotFlat &&
              cell.flat_axis < 3);
    }
  });
  for (uint32_t slot = 0; slot < size(); ++slot) {
    if (used[slot] || !hasCell(slot)) continue;
    const Cell& cell = cells_[slot];  // of an erased voxel, or never used
    require(voxels_.holds(slot) && cell.hits == 0 && !cell.stale && !cell.selected);
  }
}

size_t MomentLevel::selectedSurfaces() const {
  size_t count = 0;
  for (uint32_t slot = 0; slot < size(); ++slot) {
    count += hasCell(slot) && cells_[slot].selected ? 1 : 0;
  }
  return count;
}

size_t MomentLevel::bytes() const {
  return cells_.bytes() + voxels_.bytes() +
         (stale_.capacity() + stale_unselected_.capacity()) * sizeof(uint32_t);
}

}  // namespace edgevox
