// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "edgevox/grid/block_grid.hpp"
#include "edgevox/grid/pool.hpp"
#include "edgevox/grid/voxel.hpp"
#include "edgevox/map/packed_cell.hpp"

namespace edgevox {

/// What is kept of a frozen region beside its edge voxels and its selected surfaces. Blocks of 16
/// voxels a side come in the order of FarRegions::forEachBlock, voxels in that of their block.
struct FrozenRegion {
  std::array<uint16_t, 8> edges_to{};  ///< edge voxels up to the end of each block
  uint16_t voxels = 0;                 ///< hit voxels
  uint8_t blocks = 0;                  ///< a bit a block: whether it has any
  std::vector<uint64_t> hit_voxels;    ///< of those blocks, by appendBits()
  /// 3 bytes an edge voxel: its centroid by axis [1/256 voxel]; a bit a hit voxel: whether it is
  /// an edge before thinning; then the PackedCells of the selected voxels.
  std::vector<uint8_t> data;

  size_t edges() const { return edges_to.back(); }
  /// Where the bits in `data` begin, and the PackedCells behind them.
  size_t bitsAt() const { return kCentroidBytes * edges(); }
  size_t cellsAt() const { return bitsAt() + (size_t{voxels} + 7) / 8; }
  size_t cells() const { return (data.size() - cellsAt()) / sizeof(PackedCell); }
  size_t bytes() const {
    return sizeof(*this) + data.size() + hit_voxels.size() * sizeof(uint64_t);
  }

  static constexpr size_t kCentroidBytes = 3;

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.edges_to, self.voxels, self.blocks, self.hit_voxels, self.data);
    if constexpr (Archive::kReads) self.checkRead();
  }

 private:
  void checkRead() const;
};

/// The regions of a map: cubes of 32 voxels of level 0. Knows when a scan last touched each, and
/// keeps what is left of those that are frozen. Copies share their memory: see Pool.
class FarRegions {
 public:
  static constexpr int kShift = 5;
  static constexpr int kSide = 1 << kShift;  ///< [voxels]
  /// So near to a region's border what changes concerns the labels in it, or they what changes
  /// [voxels].
  static constexpr int kMargin = 8;

  /// -1, 0 or 1: whether a coordinate lies within kMargin of the border to a neighbour.
  static int32_t sideOf(int32_t coordinate) {
    const int32_t in_region = coordinate & (kSide - 1);
    return in_region < kMargin ? -1 : in_region >= kSide - kMargin ? 1 : 0;
  }
  static VoxelIndex regionOf(const VoxelIndex& v) { return coarser(v, kShift); }
  /// Calls visit(VoxelIndex, number) for the blocks of 16 voxels a side of a region.
  template <typename Visit>
  static void forEachBlock(const VoxelIndex& region, Visit&& visit) {
    for (int i = 0; i < 8; ++i) {
      visit(
          VoxelIndex{2 * region.x + (i & 1), 2 * region.y + (i >> 1 & 1), 2 * region.z + (i >> 2)},
          static_cast<size_t>(i));
    }
  }

  /// A voxel changes in scan `scan`: marks its region, which is made if there is none, and those
  /// within kMargin. Calls thaw(index) for those of them that are frozen.
  template <typename Thaw>
  void touch(const VoxelIndex& v, uint32_t scan, Thaw&& thaw);

  /// Of the regions that are not frozen and that no scan after `scan` has touched those farther
  /// than `distance` from `sensor`, farthest first; of the same distance in a fixed order. Both
  /// in voxels of level 0.
  std::vector<VoxelIndex> untouched(const Eigen::Vector3d& sensor, double distance,
                                    uint32_t scan) const;

  /// Null if the region is not frozen.
  const FrozenRegion* find(const VoxelIndex& region) const;
  /// Calls visit(index, FrozenRegion) in a fixed order.
  template <typename Visit>
  void forEachFrozen(Visit&& visit) const {
    for (size_t slot = 0; slot < regions_.size(); ++slot) {
      if (regions_[slot].frozen) visit(table_.block(slot), *regions_[slot].frozen);
    }
  }
  /// The region must be known.
  void freeze(const VoxelIndex& region, FrozenRegion frozen);
  /// Gives what was given to freeze() and forgets it; the region must be frozen.
  std::shared_ptr<const FrozenRegion> thaw(const VoxelIndex& region);

  size_t frozenCount() const { return frozen_count_; }
  /// The number of hit voxels in frozen regions.
  size_t frozenVoxels() const { return frozen_voxels_; }
  size_t bytes() const;

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.table_, self.regions_);
    if constexpr (Archive::kReads) self.checkRead();
  }

 private:
  struct Region {
    uint32_t last_scan = 0;                      // that touched it
    uint32_t scan = 0;                           // that set sides
    uint32_t sides = 0;                          // a bit a direction: its neighbours are touched
    std::shared_ptr<const FrozenRegion> frozen;  // null if it is not

    template <typename Self, typename Archive>
    static void archive(Self& self, Archive& bytes);
  };

  void checkRead();
  size_t slotOf(const VoxelIndex& region);
  template <typename Thaw>
  void touchSlot(size_t slot, uint32_t scan, Thaw&& thaw);
  template <typename Thaw>
  void touchNeighbours(const VoxelIndex& region, const VoxelIndex& side, uint32_t scan,
                       Thaw&& thaw);
  void count(const FrozenRegion& frozen);

  BlockTable table_;
  Pool<Region> regions_;      // by slot of table_
  std::vector<size_t> near_;  // slots of those that are not frozen
  size_t frozen_count_ = 0;
  size_t frozen_voxels_ = 0;
  size_t frozen_bytes_ = 0;
};

template <typename Self, typename Archive>
void FarRegions::Region::archive(Self& self, Archive& bytes) {
  bool is_frozen = self.frozen != nullptr;
  bytes(self.last_scan, self.scan, self.sides, is_frozen);
  if (!is_frozen) return;
  if constexpr (Archive::kReads) {
    const auto frozen = std::make_shared<FrozenRegion>();
    bytes(*frozen);
    self.frozen = frozen;
  } else {
    bytes(*self.frozen);
  }
}

template <typename Thaw>
void FarRegions::touch(const VoxelIndex& v, uint32_t scan, Thaw&& thaw) {
  const VoxelIndex index = regionOf(v);
  const size_t slot = slotOf(index);
  touchSlot(slot, scan, thaw);
  if (frozenCount() == 0) return;
  const VoxelIndex side{sideOf(v.x), sideOf(v.y), sideOf(v.z)};
  if (side == VoxelIndex{}) return;
  const uint32_t bit = 1U << (13 + side.x + 3 * side.y + 9 * side.z);
  const bool first = regions_[slot].scan != scan;
  if (!first && (regions_[slot].sides & bit) != 0) return;
  Region& region = regions_.edit(slot);
  region.sides = first ? bit : region.sides | bit;
  region.scan = scan;
  touchNeighbours(index, side, scan, thaw);
}

template <typename Thaw>
void FarRegions::touchSlot(size_t slot, uint32_t scan, Thaw&& thaw) {
  if (regions_[slot].last_scan != scan) regions_.edit(slot).last_scan = scan;
  if (regions_[slot].frozen) thaw(table_.block(slot));
}

template <typename Thaw>
void FarRegions::touchNeighbours(const VoxelIndex& region, const VoxelIndex& side, uint32_t scan,
                                 Thaw&& thaw) {
  for (int i = 1; i < 8; ++i) {
    const VoxelIndex step{(i & 1) * side.x, (i >> 1 & 1) * side.y, (i >> 2) * side.z};
    if (step == VoxelIndex{}) continue;
    const int32_t slot = table_.find({region.x + step.x, region.y + step.y, region.z + step.z});
    if (slot != BlockTable::kNone) touchSlot(static_cast<size_t>(slot), scan, thaw);
  }
}

}  // namespace edgevox
