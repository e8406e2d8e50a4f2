// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include <Eigen/Core>

#include "edgevox/block_grid.hpp"
#include "edgevox/pool.hpp"
#include "edgevox/voxel.hpp"

namespace edgevox {

/// Where the surface in a voxel lies and how well each direction is known.
struct VoxelGaussian {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();  ///< [m]
  /// xx, yy, zz, xy, yz, zx of C^-1 - lambda_min(C^-1) I [1/m^2]: none along the surface
  std::array<float, 6> information{};
  /// A surface is not seen from behind: only points whose unit vector to the sensor has a product
  /// above -1 with `side` are of this one.
  Eigen::Vector3f side = Eigen::Vector3f::Zero();
  uint32_t twin = kNoTwin;  ///< the surface in the same voxel seen from the other side

  static constexpr uint32_t kNoTwin = 0xffffffff;
  bool facesAway(const Eigen::Vector3f& to_sensor) const { return side.dot(to_sensor) < -1.0F; }
};

/// Sums over points about some origin.
struct Moments {
  double count = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();    ///< [m]
  Eigen::Matrix3d outer = Eigen::Matrix3d::Zero();  ///< [m^2]

  /// `count` points at one place.
  static Moments at(const Eigen::Vector3d& point, double count);
  Moments& operator+=(const Moments& more);
  /// Of the same points about another origin.
  Moments about(const Eigen::Vector3d& origin) const;
};

/// The voxels of one size with their Gaussians. Which of them are `selected` depends on the
/// representation of the map.
class GaussianLevel {
 public:
  struct Cell {
    std::array<float, 3> sum{};    ///< of the centroids, from the voxel's centre [m]
    std::array<float, 6> outer{};  ///< xx, yy, zz, xy, yz, zx of the same [m^2]
    std::array<float, 3> view{};   ///< sum of the unit vectors to the sensor
    uint32_t count = 0;            ///< centroids
    uint32_t last_scan = 0;
    uint16_t hits = 0;            ///< scans
    uint8_t edge_children = 0;    ///< finer voxels that are or hold edges
    int8_t flat_axis = kNotFlat;  ///< as of the last findFlatAxis()
    bool anchor = false;          ///< see AnchorRule
    bool stale = false;           ///< changed since its Gaussian was computed
    bool is_twin = false;         ///< only sums, count and view are its own
    bool selected = false;        ///< for matching; a twin follows its voxel
  };
  static constexpr int8_t kNotFlat = -1;

  explicit GaussianLevel(double voxel_size) : voxel_size_(voxel_size) {}

  double voxelSize() const { return voxel_size_; }

  /// A voxel and its six neighbours, as far as they are selected or, for `all`, occupied.
  struct Around {
    VoxelIndex voxel;
    uint32_t count = 0;
    std::array<uint32_t, 7> slots{};
  };
  Around around(const VoxelIndex& voxel, bool all) const;
  VoxelIndex voxelOf(const Eigen::Vector3f& point) const {
    return voxelAt(point, 1.0 / voxel_size_);
  }

  /// Of the surfaces in these voxels that face `to_sensor` (a unit vector) the one nearest to
  /// `point` by its information. Its squared Mahalanobis distance goes to `distance`. Null if there
  /// is none. Gaussians of voxels that are not selected are as of the last updateAll().
  const VoxelGaussian* nearest(const Around& around, const Eigen::Vector3f& point,
                               const Eigen::Vector3f& to_sensor, float& distance) const;

  /// The slot of a voxel's cell, which is made if there is none.
  uint32_t slotFor(const VoxelIndex& v);
  /// Adds a centroid of scan `scan` (counted from 1), seen along the unit vector `to_sensor`; true
  /// if it is the scan's first there.
  bool add(uint32_t slot, const Eigen::Vector3d& centroid, const Eigen::Vector3f& to_sensor,
           uint32_t scan);
  /// Replaces the points of a voxel without a twin, about its centre; from where they were seen
  /// stays.
  void setMoments(uint32_t slot, const Moments& moments);
  /// Takes an occupied voxel out.
  void erase(const VoxelIndex& v);
  /// Computes the Gaussians of the selected cells that have changed.
  void updateSelected();
  /// Those of all cells that have changed.
  void updateAll();
  void select(uint32_t slot, bool selected);
  /// Sets Cell::flat_axis: the axis nearest to the normal if the voxel is flat.
  void findFlatAxis(uint32_t slot);

  uint32_t slotOf(const VoxelIndex& v) const { return grid_.find(v); }
  Cell& cell(uint32_t slot) { return cells_[slot]; }
  const Cell& cell(uint32_t slot) const { return cells_[slot]; }
  const VoxelIndex& voxel(uint32_t slot) const { return voxels_[slot]; }
  size_t size() const { return cells_.size(); }
  /// Of the first side, about the voxel's centre.
  Moments moments(uint32_t slot) const;
  bool hasTwin(uint32_t slot) const { return gaussians_[slot].twin != VoxelGaussian::kNoTwin; }
  /// Unit normal of the first side, zero if that is not flat.
  Eigen::Vector3d normal(uint32_t slot) const;
  /// The block of 8 voxels a side that holds the voxel of a slot.
  size_t blockOf(uint32_t slot) const {
    return static_cast<size_t>(grid_.findBlock(Layout::block(voxels_[slot])));
  }
  /// Calls visit(slot) for the voxels of a block in a fixed order.
  template <typename Visit>
  void forEachInBlock(size_t block, Visit&& visit) const {
    grid_.forEachInBlock(block, visit);
  }
  const VoxelGaussian& gaussian(uint32_t slot) const { return gaussians_[slot]; }
  /// Voxels.
  size_t selectedCount() const { return selected_count_; }
  /// Gaussians of the selected voxels.
  size_t selectedGaussians() const;
  size_t blocksWithSelection() const;
  size_t bytes() const;

 private:
  using Grid = SlotGrid<8>;
  using Layout = Grid::Layout;

  /// Of the next new cell: one that has been erased, or behind all others.
  uint32_t nextSlot() const;
  uint32_t newCell(const VoxelIndex& v);
  void freeCell(uint32_t slot);
  uint32_t sideSlot(uint32_t slot, const Eigen::Vector3f& to_sensor);
  void setStale(uint32_t slot);
  enum class Side { kKeep, kRefresh };
  /// What a look at unselected voxels computes must not change where later centroids go: it keeps
  /// the side.
  void update(uint32_t slot, Side side);
  void dropRepeats();

  double voxel_size_;
  Grid grid_;
  std::deque<Grid::Bits> selected_;  // one a block of grid_
  size_t selected_count_ = 0;
  Pool<Cell> cells_;
  Pool<VoxelIndex> voxels_;
  Pool<VoxelGaussian> gaussians_;
  std::vector<uint32_t> free_;              // erased slots
  std::vector<uint32_t> stale_;             // slots stale since the last update of any kind
  std::vector<uint32_t> stale_unselected_;  // before that; some are updated since, or repeated
};

/// Which voxels stand for a block of 8 voxels a side: of the flat ones `count` for each of three
/// directions of the normal; where there are fewer than `count` in all, voxels that hold edges make
/// up for them. Chosen by a hash of the voxel, so that a choice changes little when voxels come.
struct AnchorRule {
  int count = 0;
  int min_hits = 1;
};
/// Sets Cell::anchor of the voxels of a block by their Cell::flat_axis, edge_children and hits.
void chooseAnchors(GaussianLevel& level, size_t block, const AnchorRule& rule);

}  // namespace edgevox
