// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/map/plane_level.hpp"

#include <algorithm>
#include <vector>

namespace edgevox {
namespace {

constexpr float kBehind = 0.02F;  // cosine to the normal of a plane seen from behind

}  // namespace

bool Plane::facesAway(const Eigen::Vector3f& to_sensor) const {
  return normal.dot(to_sensor) < -kBehind;
}

const Plane* PlaneLevel::find(const VoxelIndex& v, const Eigen::Vector3f& to_sensor) const {
  const VoxelPlanes* planes = find(v);
  if (planes == nullptr) return nullptr;
  const Plane* found = std::find_if(planes->begin(), planes->end(), [&](const Plane& plane) {
    return !plane.facesAway(to_sensor);
  });
  return found == planes->end() ? nullptr : found;
}

void PlaneLevel::set(const VoxelIndex& v, const VoxelPlanes& planes) {
  uint32_t slot = grid_.find(v);
  if (planes.count == 0) {
    if (slot == Grid::kNone) return;
    planes_.edit(slot) = {};
    slots_.giveBack(slot);
    slots_.dropIfFree(slot, planes_);
    grid_.erase(v);
    return;
  }
  if (slot == Grid::kNone) {
    slot = slots_.take(Slots::kNear);
    grid_.insert(v, slot);
    planes_.hold(slot);
  }
  if (!(planes_[slot] == planes)) planes_.edit(slot) = planes;
}

size_t PlaneLevel::planeCount() const {
  size_t planes = 0;
  forEachVoxel([&](const VoxelIndex&, const VoxelPlanes& of_voxel) { planes += of_voxel.count; });
  return planes;
}

void PlaneLevel::checkRead() {
  std::vector<bool> used(slots_.end());
  for (size_t block = 0; block < grid_.blockCount(); ++block) {
    grid_.forEachVoxelInBlock(block, [&](const VoxelIndex&, uint32_t slot) {
      if (slot >= used.size() || !planes_.holds(slot) || used[slot]) {
        throw ArchiveError("a voxel has no planes of its own");
      }
      const VoxelPlanes& planes = planes_[slot];
      if (planes.count < 1 || planes.count > planes.sides.size()) {
        throw ArchiveError("a voxel has no planes");
      }
      used[slot] = true;
    });
  }
  slots_.checkRead(used);
}

}  // namespace edgevox
