// SPDX-License-Identifier: BSD-3-Clause
// Points that stand alone enter the map when a later scan confirms them.
#include "edgevox/map/lone_voxels.hpp"

#include <algorithm>
#include <utility>

#include "edgevox/map/map_builder.hpp"

namespace edgevox {
namespace {

constexpr uint16_t kEstablished = 2;  // hits of a voxel whose neighbours are not alone
constexpr int kCompany = 2;           // points around one that does not stand alone

/// Whether at least `wanted` of the 26 voxels around v pass the test.
template <typename Test>
bool areAround(const VoxelIndex& v, int wanted, const Test& test) {
  constexpr int kSelf = 13;
  for (int i = 0; i < 27 && wanted > 0; ++i) {
    if (i == kSelf) continue;
    if (test(VoxelIndex{v.x + i % 3 - 1, v.y + i / 3 % 3 - 1, v.z + i / 9 - 1})) --wanted;
  }
  return wanted <= 0;
}

}  // namespace

void ScanNeighbours::set(const std::vector<VoxelIndex>& voxels) {
  once_.clear();
  twice_.clear();
  more_.clear();
  for (const VoxelIndex& v : voxels) {
    const VoxelIndex parent = coarser(v, 1);
    if (!once_.set(parent) && !twice_.set(parent)) more_.set(parent);
  }
}

bool ScanNeighbours::isAlone(const VoxelIndex& parent) const {
  const int beside = (twice_.test(parent) ? 1 : 0) + (more_.test(parent) ? 1 : 0);
  BitReader<8> points(once_);
  return !areAround(parent, kCompany - beside, [&](const VoxelIndex& v) { return points.test(v); });
}

void RecentVoxels::nextScan() {
  if (++age_ < half_) return;
  age_ = 0;
  older_ = std::exchange(recent_, BlockTable());
}

bool RecentVoxels::findOrInsert(const VoxelIndex& v) {
  if (older_.find(v) != BlockTable::kNone) return true;
  const size_t known = recent_.size();
  recent_.findOrInsert(v);
  return recent_.size() == known;
}

void RecentVoxels::clear() {
  recent_ = BlockTable();
  older_ = BlockTable();
}

/// Stray returns, rain and dust would else stay for ever, at the price of blocks of their own.
void MapBuilder::leaveOutLone() {
  if (config_.confirm_within == 0) return;
  lone_voxels_.nextScan();
  const auto is_known = [this](const VoxelIndex& v) {
    return match_map_.occupied(1).test(coarser(v, 1));
  };
  if (std::all_of(scan_.voxels.begin(), scan_.voxels.end(), is_known)) return;
  scan_.neighbours.set(scan_.voxels);
  const size_t all = scan_.voxels.size();
  keepPoints([&](const VoxelIndex& v) {
    const VoxelIndex parent = coarser(v, 1);
    return is_known(v) || !scan_.neighbours.isAlone(parent) || isBesideEstablished(parent) ||
           lone_voxels_.findOrInsert(v);
  });
  left_out_lone_ += all - scan_.voxels.size();
}

bool MapBuilder::isBesideEstablished(const VoxelIndex& parent) const {
  const SurfaceLevel& surfaces = match_map_.surfaces();
  BitReader<8> occupied(match_map_.occupied(1));
  return areAround(parent, 1, [&](const VoxelIndex& v) {
    if (!occupied.test(v)) return false;
    const uint32_t slot = surfaces.slotOf(v);
    if (slot == SurfaceLevel::kNone || !moments_.hasCell(slot))
      return isHitWithin(v) || isFrozen({2 * v.x, 2 * v.y, 2 * v.z});
    return moments_.cell(slot).hits >= kEstablished;
  });
}

/// A map as large as it may be keeps what it knows up to date.
void MapBuilder::leaveOutNew() {
  const size_t all = scan_.voxels.size();
  keepPoints([this](const VoxelIndex& v) {
    return isHit(v) || (isFrozen(v) && match_map_.occupied(1).test(coarser(v, 1)));
  });
  left_out_full_ += all - scan_.voxels.size();
}

}  // namespace edgevox
