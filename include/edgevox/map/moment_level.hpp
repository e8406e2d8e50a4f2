// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "edgevox/grid/pool.hpp"
#include "edgevox/grid/voxel.hpp"
#include "edgevox/map/packed_cell.hpp"
#include "edgevox/map/surface.hpp"
#include "edgevox/map/surface_level.hpp"

namespace edgevox {

/// The sums over the centroids in a voxel of level 1.
struct MomentCell {
  static constexpr int8_t kNotFlat = -1;

  std::array<float, 3> sum{};    ///< of the centroids, from the voxel's centre [m]
  std::array<float, 6> outer{};  ///< xx, yy, zz, xy, yz, zx of the same [m^2]
  std::array<float, 3> view{};   ///< sum of the unit vectors to the sensor
  uint32_t count = 0;            ///< centroids
  uint32_t last_scan = 0;
  uint16_t hits = 0;            ///< scans
  uint8_t edge_children = 0;    ///< voxels in it that are edges
  int8_t flat_axis = kNotFlat;  ///< as of the last findFlatAxis()
  bool anchor = false;          ///< see AnchorRule
  bool stale = false;           ///< changed since its surface was computed
  bool is_back = false;         ///< only sums, count and view are its own
  bool explained = false;       ///< lies in a plane of coarser voxels
  bool selected = false;        ///< for matching; a back surface follows its voxel

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.sum, self.outer, self.view, self.count, self.last_scan, self.hits,
          self.edge_children, self.flat_axis, self.anchor, self.stale, self.is_back, self.explained,
          self.selected);
  }
};

/// The sums over centroids from which surfaces and planes are computed, in the surfaces' slots.
/// Slots of kind Slots::kFar have none: those of selected voxels are kept packed, elsewhere.
/// Which of them are `selected` depends on the representation of the map. Copies share their
/// memory: see Pool.
class MomentLevel {
 public:
  using Cell = MomentCell;
  static constexpr int8_t kNotFlat = Cell::kNotFlat;
  static constexpr size_t kCellBytes = sizeof(Cell) + sizeof(VoxelIndex);

  explicit MomentLevel(double voxel_size) : voxel_size_(voxel_size) {}

  /// The slot of a voxel, which is made if there is none.
  uint32_t slotFor(const VoxelIndex& v, SurfaceLevel& surfaces);
  /// Adds a centroid of scan `scan` (counted from 1), seen along the unit vector `to_sensor`; true
  /// if it is the scan's first there.
  bool add(uint32_t slot, const Eigen::Vector3d& centroid, const Eigen::Vector3f& to_sensor,
           uint32_t scan, SurfaceLevel& surfaces);
  /// Replaces the points of a voxel without a back surface, about its centre; from where they were
  /// seen stays.
  void setMoments(uint32_t slot, const Moments& moments);
  /// Takes an occupied voxel out.
  void erase(const VoxelIndex& v, SurfaceLevel& surfaces);
  /// Puts the cells of a voxel, first side first, behind `packed` and takes them out; its surfaces
  /// stay.
  void pack(const VoxelIndex& v, SurfaceLevel& surfaces, std::vector<PackedCell>& packed);
  /// Makes the cells again, of which `packed` is the first; gives the one behind the last.
  const PackedCell* unpack(const VoxelIndex& v, SurfaceLevel& surfaces, const PackedCell* packed,
                           uint8_t edge_children);
  /// Computes the surfaces of the selected cells that have changed.
  void updateSelected(SurfaceLevel& surfaces);
  /// Computes the surfaces of all cells that have changed.
  void updateAll(SurfaceLevel& surfaces);
  void select(uint32_t slot, bool selected, SurfaceLevel& surfaces);
  /// Sets Cell::flat_axis: the axis nearest to the normal if the voxel is flat.
  void findFlatAxis(uint32_t slot);

  /// To be written to; stays where it is until the level is copied.
  Cell& editCell(uint32_t slot) { return cells_.edit(slot); }
  const Cell& cell(uint32_t slot) const { return cells_[slot]; }
  const VoxelIndex& voxel(uint32_t slot) const { return voxels_[slot]; }
  /// A number above all slots, of which some may be free or have no cell.
  size_t size() const { return cells_.size(); }
  /// Whether cell() may be called; an erased one may be there still, without hits.
  bool hasCell(uint32_t slot) const { return cells_.holds(slot); }
  /// The moments of the first side, about the voxel's centre.
  Moments moments(uint32_t slot) const;
  /// Unit normal of the first side, zero if that is not flat.
  Eigen::Vector3d normal(uint32_t slot) const;
  /// The number of surfaces of the selected voxels that have cells.
  size_t selectedSurfaces() const;
  size_t bytes() const;

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.cells_, self.voxels_, self.stale_, self.stale_unselected_);
  }
  /// Throws ArchiveError unless it fits to `surfaces`, when both have been read.
  void checkRead(const SurfaceLevel& surfaces) const;

 private:
  void makeCell(uint32_t slot, const VoxelIndex& v);
  uint32_t sideSlot(uint32_t slot, const Eigen::Vector3f& to_sensor, SurfaceLevel& surfaces);
  void dropCell(uint32_t slot, const SurfaceLevel& surfaces);
  void setStale(uint32_t slot);
  bool isStale(uint32_t slot) const { return hasCell(slot) && cells_[slot].stale; }
  enum class Side { kKeep, kRefresh };
  /// What a look at unselected voxels computes must not change where later centroids go: it keeps
  /// the side.
  void update(uint32_t slot, Side side, SurfaceLevel& surfaces);
  void dropRepeats();

  double voxel_size_;
  Pool<Cell> cells_;
  Pool<VoxelIndex> voxels_;
  std::vector<uint32_t> stale_;             // slots stale since the last update of any kind
  std::vector<uint32_t> stale_unselected_;  // before that; some are updated since, or repeated
};

/// Which voxels stand for a block of 8 voxels a side besides its planes: of those that lie in none
/// all that hold edges and `count` flat ones for each of three directions of the normal. Chosen by
/// a hash of the voxel, so that a choice changes little when voxels come.
struct AnchorRule {
  int count = 0;
  int min_hits = 1;
};
/// Sets Cell::anchor of the voxels of a block by their Cell::flat_axis, edge_children and hits.
void chooseAnchors(MomentLevel& level, const SurfaceLevel& surfaces, size_t block,
                   const AnchorRule& rule);

}  // namespace edgevox
