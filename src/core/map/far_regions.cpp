// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/map/far_regions.hpp"

#include <algorithm>
#include <utility>

#include "edgevox/archive.hpp"

namespace edgevox {

void FrozenRegion::checkRead() const {
  const auto fail = [] { throw ArchiveError("a frozen region is not whole"); };
  if (!std::is_sorted(edges_to.begin(), edges_to.end())) fail();
  if (data.size() < cellsAt() || (data.size() - cellsAt()) % sizeof(PackedCell) != 0) fail();
  size_t word = 0;
  size_t bits = 0;
  for (uint64_t left = bitCount(blocks); left > 0; --left) {
    if (word == hit_voxels.size()) fail();
    const size_t end = word + 1 + bitCount(hit_voxels[word]);
    if (end > hit_voxels.size()) fail();
    while (++word < end) bits += bitCount(hit_voxels[word]);
  }
  if (word != hit_voxels.size() || bits != voxels) fail();
}

size_t FarRegions::slotOf(const VoxelIndex& region) {
  const auto slot = static_cast<size_t>(table_.findOrInsert(region));
  if (slot == regions_.size()) {
    regions_.grow();
    near_.push_back(slot);
  }
  return slot;
}

std::vector<VoxelIndex> FarRegions::untouched(const Eigen::Vector3d& sensor, double distance,
                                              uint32_t scan) const {
  std::vector<std::pair<double, VoxelIndex>> found;  // by the squared distance, negative
  for (const size_t slot : near_) {
    if (regions_[slot].last_scan > scan) continue;
    const VoxelIndex& index = table_.block(slot);
    const double squared = (voxelCentre(index, kSide) - sensor).squaredNorm();
    if (squared > distance * distance) found.emplace_back(-squared, index);
  }
  std::sort(found.begin(), found.end());
  std::vector<VoxelIndex> regions(found.size());
  std::transform(found.begin(), found.end(), regions.begin(),
                 [](const auto& region) { return region.second; });
  return regions;
}

const FrozenRegion* FarRegions::find(const VoxelIndex& region) const {
  const int32_t slot = table_.find(region);
  return slot == BlockTable::kNone ? nullptr : regions_[static_cast<size_t>(slot)].frozen.get();
}

void FarRegions::count(const FrozenRegion& frozen) {
  ++frozen_count_;
  frozen_voxels_ += frozen.voxels;
  frozen_bytes_ += frozen.bytes();
}

void FarRegions::freeze(const VoxelIndex& region, FrozenRegion frozen) {
  const auto slot = static_cast<size_t>(table_.find(region));
  near_.erase(std::find(near_.begin(), near_.end(), slot));
  frozen.data.shrink_to_fit();
  frozen.hit_voxels.shrink_to_fit();
  count(frozen);
  regions_.edit(slot).frozen = std::make_shared<const FrozenRegion>(std::move(frozen));
}

std::shared_ptr<const FrozenRegion> FarRegions::thaw(const VoxelIndex& region) {
  const auto slot = static_cast<size_t>(table_.find(region));
  near_.push_back(slot);
  auto frozen = std::exchange(regions_.edit(slot).frozen, nullptr);
  --frozen_count_;
  frozen_voxels_ -= frozen->voxels;
  frozen_bytes_ -= frozen->bytes();
  return frozen;
}

size_t FarRegions::bytes() const {
  return table_.bytes() + regions_.bytes() + frozen_bytes_ + near_.capacity() * sizeof(size_t);
}

void FarRegions::checkRead() {
  if (regions_.size() != table_.size() || table_.freeCount() > 0) {
    throw ArchiveError("the regions do not fit to their places");
  }
  near_.clear();
  frozen_count_ = 0;
  frozen_voxels_ = 0;
  frozen_bytes_ = 0;
  for (size_t slot = 0; slot < regions_.size(); ++slot) {
    if (regions_[slot].frozen) {
      count(*regions_[slot].frozen);
    } else {
      near_.push_back(slot);
    }
  }
}

}  // namespace edgevox
