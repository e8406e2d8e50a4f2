// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "edgevox/grid/block_grid.hpp"
#include "edgevox/grid/pool.hpp"
#include "edgevox/grid/slots.hpp"
#include "edgevox/grid/voxel.hpp"

namespace edgevox {

/// Where the surface in a voxel lies and how well each direction is known: a Gaussian.
struct Surface {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();  ///< [m]
  /// xx, yy, zz, xy, yz, zx of C^-1 - lambda_min(C^-1) I [1/m^2]: none along the surface
  std::array<float, 6> information{};
  /// A surface is not seen from behind: only points whose unit vector to the sensor has a product
  /// above -1 with `side` are of this one.
  Eigen::Vector3f side = Eigen::Vector3f::Zero();
  uint32_t back_surface = kNone;  ///< slot of the surface in the same voxel seen from behind

  static constexpr uint32_t kNone = 0xffffffff;
  bool facesAway(const Eigen::Vector3f& to_sensor) const { return side.dot(to_sensor) < -1.0F; }

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.mean, self.information, self.side, self.back_surface);
  }
};

/// The surfaces in voxels of one size, found by voxel. Scans are matched to the `selected` ones or,
/// as far as they are known, to all. Copies share their memory: see Pool.
class SurfaceLevel {
 public:
  static constexpr uint32_t kNone = Surface::kNone;

  explicit SurfaceLevel(double voxel_size) : voxel_size_(voxel_size) {}

  double voxelSize() const { return voxel_size_; }
  VoxelIndex voxelOf(const Eigen::Vector3f& point) const {
    return voxelAt(point, 1.0 / voxel_size_);
  }

  /// A voxel and its six neighbours, as far as they are selected or, for `all`, occupied.
  struct Around {
    VoxelIndex voxel;
    uint32_t count = 0;
    std::array<uint32_t, 7> slots{};
  };
  Around around(const VoxelIndex& voxel, bool all) const;

  /// Of the surfaces in these voxels that face `to_sensor` (a unit vector) the one nearest to
  /// `point` by its information. Its squared Mahalanobis distance goes to `distance`. Null if there
  /// is none.
  const Surface* nearest(const Around& around, const Eigen::Vector3f& point,
                         const Eigen::Vector3f& to_sensor, float& distance) const;

  /// The slot of the first surface of a voxel, kNone if there is none.
  uint32_t slotOf(const VoxelIndex& v) const { return grid_.find(v); }
  const Surface& surface(uint32_t slot) const { return surfaces_[slot]; }
  bool isSelected(const VoxelIndex& v) const;
  bool hasBack(uint32_t slot) const { return surfaces_[slot].back_surface != kNone; }
  /// A number above all slots, of which some may be free.
  size_t slotCount() const { return surfaces_.size(); }
  const Slots& slots() const { return slots_; }
  /// The number of selected voxels.
  size_t selectedCount() const { return selected_count_; }
  size_t bytes() const;
  /// The part of bytes() that is free and will be used again.
  size_t freeBytes() const;

  /// The block of 8 voxels a side that holds a voxel.
  size_t blockOf(const VoxelIndex& v) const {
    return static_cast<size_t>(grid_.findBlock(Grid::Layout::block(v)));
  }
  /// Calls visit(slot) for the voxels of a block in a fixed order.
  template <typename Visit>
  void forEachInBlock(size_t block, Visit&& visit) const {
    grid_.forEachInBlock(block, visit);
  }
  /// Calls visit(VoxelIndex, slot) for all voxels, or those of the block with this index, if there
  /// is one. Voxels must neither come nor go.
  template <typename Visit>
  void forEachVoxel(Visit&& visit) const {
    for (size_t block = 0; block < grid_.blockCount(); ++block) {
      grid_.forEachVoxelInBlock(block, visit);
    }
  }
  template <typename Visit>
  void forEachVoxelInBlock(const VoxelIndex& block, Visit&& visit) const {
    const int32_t found = grid_.findBlock(block);
    if (found != BlockTable::kNone) grid_.forEachVoxelInBlock(static_cast<size_t>(found), visit);
  }

  /// The slot of a voxel, which is made if there is none.
  uint32_t insert(const VoxelIndex& v);
  /// A new slot for the back of a voxel's surface.
  uint32_t insertBack(uint32_t slot);
  /// Takes out a voxel's surface with its back; the slots are used again.
  void erase(const VoxelIndex& v);
  /// Moves the surfaces of a voxel to slots of the other kind.
  void move(const VoxelIndex& v, Slots::Kind to);
  /// Gives back what a block holds beyond its voxels.
  void shrinkBlock(const VoxelIndex& block);
  /// To be written to; stays where it is until the level is copied.
  Surface& editSurface(uint32_t slot) { return surfaces_.edit(slot); }
  /// Selects, or not, a voxel that has a slot.
  void setSelected(const VoxelIndex& v, bool selected);

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.grid_, self.selected_, self.surfaces_, self.slots_);
    if constexpr (Archive::kReads) self.checkRead();
  }

 private:
  using Grid = SlotGrid<8>;

  void checkRead();
  std::vector<bool> slotsInUse() const;
  uint32_t takeSlot(Slots::Kind kind);
  void giveBack(uint32_t slot);

  double voxel_size_;
  Grid grid_;
  Pool<Grid::Bits> selected_;  // one a block of grid_
  size_t selected_count_ = 0;
  Pool<Surface> surfaces_;
  Slots slots_;
};

}  // namespace edgevox
