// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "edgevox/grid/block_grid.hpp"
#include "edgevox/grid/pool.hpp"
#include "edgevox/grid/slots.hpp"
#include "edgevox/grid/voxel.hpp"

namespace edgevox {

/// A plane through a voxel: the points p with normal . (p - centre of the voxel) = offset.
struct Plane {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit, to where it was seen from
  float offset = 0.0F;                               ///< [m]
  float information = 0.0F;                          ///< of a position across it [1/m^2]

  bool facesAway(const Eigen::Vector3f& to_sensor) const;
  bool operator==(const Plane& other) const {
    return normal == other.normal && offset == other.offset && information == other.information;
  }

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.normal, self.offset, self.information);
  }
};

/// The planes of a voxel: one, or those of the two sides of a wall.
struct VoxelPlanes {
  std::array<Plane, 2> sides;
  uint32_t count = 0;
  uint32_t points = 0;     ///< in the voxel when they were fitted
  uint32_t voxels = 0;     ///< sides of voxels of level 1 that held these
  bool forgotten = false;  ///< whether some of these have been dropped since

  void add(const Plane& plane) { sides[count++] = plane; }
  bool operator==(const VoxelPlanes& other) const {
    return sides == other.sides && count == other.count && points == other.points &&
           voxels == other.voxels && forgotten == other.forgotten;
  }
  const Plane* begin() const { return sides.data(); }
  const Plane* end() const { return sides.data() + count; }

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.sides, self.count, self.points, self.voxels, self.forgotten);
  }
};

/// The planes in voxels of one size, found by voxel. Copies share their memory: see Pool.
class PlaneLevel {
 public:
  explicit PlaneLevel(double voxel_size) : voxel_size_(voxel_size) {}

  double voxelSize() const { return voxel_size_; }
  VoxelIndex voxelOf(const Eigen::Vector3f& point) const {
    return voxelAt(point, 1.0 / voxel_size_);
  }
  /// Null if the voxel has none.
  const VoxelPlanes* find(const VoxelIndex& v) const {
    const uint32_t slot = grid_.find(v);
    return slot == Grid::kNone ? nullptr : &planes_[slot];
  }
  /// The plane of a voxel that faces the unit vector `to_sensor`, null if there is none.
  const Plane* find(const VoxelIndex& v, const Eigen::Vector3f& to_sensor) const;

  /// The voxel has these planes, of which there may be none, and no others. Where it has them
  /// already nothing is written, so that copies go on sharing.
  void set(const VoxelIndex& v, const VoxelPlanes& planes);

  /// The number of voxels with planes.
  size_t count() const { return slots_.usedCount(Slots::kNear); }
  /// Of all voxels, of both sides.
  size_t planeCount() const;
  /// Calls visit(VoxelIndex, VoxelPlanes) in a fixed order.
  template <typename Visit>
  void forEachVoxel(Visit&& visit) const {
    for (size_t block = 0; block < grid_.blockCount(); ++block) {
      grid_.forEachVoxelInBlock(
          block, [&](const VoxelIndex& v, uint32_t slot) { visit(v, planes_[slot]); });
    }
  }
  size_t bytes() const { return grid_.bytes() + planes_.bytes() + slots_.bytes(); }
  /// The part of bytes() that is free and will be used again.
  size_t freeBytes() const {
    return grid_.freeBytes() + slots_.freeCount(Slots::kNear) * sizeof(VoxelPlanes);
  }

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.grid_, self.planes_, self.slots_);
    if constexpr (Archive::kReads) self.checkRead();
  }

 private:
  using Grid = SlotGrid<8>;

  void checkRead();

  double voxel_size_;
  Grid grid_;
  Pool<VoxelPlanes> planes_;
  Slots slots_;
};

}  // namespace edgevox
