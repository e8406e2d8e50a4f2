// SPDX-License-Identifier: BSD-3-Clause
// Whether the parts of a map that was read fit to one another.
#include <vector>

#include "edgevox/archive.hpp"
#include "edgevox/map/map_builder.hpp"

namespace edgevox {
namespace {

void require(bool good, const char* error) {
  if (!good) throw ArchiveError(error);
}

}  // namespace

void MapBuilder::checkRead() {
  checkHits();
  moments_.checkRead(match_map_.surfaces());
  checkSurfaces();
  far_.forEachFrozen([this](const VoxelIndex& region, const FrozenRegion& frozen) {
    checkFrozen(region, frozen);
  });
}

/// Every voxel of a region that is not frozen has its hits, and no other.
void MapBuilder::checkHits() {
  const char* error = "the hits do not fit to their voxels";
  std::vector<bool> used(hit_slots_.end());
  for (size_t block = 0; block < hit_grid_.blockCount(); ++block) {
    hit_grid_.forEachVoxelInBlock(block, [&](const VoxelIndex& v, uint32_t slot) {
      require(slot < used.size() && hits_.holds(slot) && !used[slot] && !isFrozen(v), error);
      used[slot] = true;
    });
  }
  hit_slots_.checkRead(used);
  match_map_.hitVoxels().forEach([&](const VoxelIndex& v) { require(isHit(v), error); });
  edgeVoxels().forEach([&](const VoxelIndex& v) { require(isHit(v) || isFrozen(v), error); });
}

/// The surfaces of frozen regions, and no others, have no moments.
void MapBuilder::checkSurfaces() const {
  const char* error = "the surfaces do not fit to the frozen regions";
  const SurfaceLevel& surfaces = match_map_.surfaces();
  surfaces.forEachVoxel([&](const VoxelIndex& v, uint32_t slot) {
    const VoxelIndex region = coarser(v, FarRegions::kShift - 1);
    const bool far = surfaces.slots().kindOf(slot) == Slots::kFar;
    require(far == (far_.find(region) != nullptr), error);
  });
}

}  // namespace edgevox
