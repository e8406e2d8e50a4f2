// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include <Eigen/Core>

#include "edgevox/block_grid.hpp"
#include "edgevox/config.hpp"
#include "edgevox/edge_extractor.hpp"
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
  using Layout = BlockLayout<8>;
  using Bits = std::array<uint8_t, Layout::kRows>;

  uint32_t newCell(const VoxelIndex& v);
  uint32_t newTwin(const VoxelIndex& v);
  uint32_t sideSlot(uint32_t slot, const Eigen::Vector3f& to_sensor);
  void setStale(uint32_t slot);
  enum class Side { kKeep, kRefresh };
  /// What a look at unselected voxels computes must not change where later centroids go: it keeps
  /// the side.
  void update(uint32_t slot, Side side);
  void dropRepeats();

  double voxel_size_;
  SlotGrid<8> grid_;
  std::deque<Bits> selected_;  // one a block of grid_
  size_t selected_count_ = 0;
  Pool<Cell> cells_;
  Pool<VoxelIndex> voxels_;
  Pool<VoxelGaussian> gaussians_;
  std::vector<uint32_t> free_twins_;
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

/// A multi-resolution occupied voxel list (Ryde and Hu 2010). Level k has voxels of
/// voxel_size * 2^k. Level 0 counts hits and holds the edge labels of the accumulated occupancy;
/// levels 1 to kGaussianLevels hold Gaussians for the refinement; all from 1 on hold the bits of
/// all occupied voxels for the search.
class OccupiedVoxelMap {
 public:
  static constexpr int kGaussianLevels = 2;

  /// `coarsest_voxel` [m] fixes the number of levels.
  OccupiedVoxelMap(double voxel_size, double coarsest_voxel, const MapConfig& map,
                   const EdgeConfig& edges, int threads);

  /// add(), then label() when it is due.
  void insert(const std::vector<Eigen::Vector3d>& centroids, const Eigen::Vector3d& sensor);
  /// Adds one scan's centroids, seen from `sensor`, in the map frame [m]; those out of the grid's
  /// range are ignored and counted.
  void add(const std::vector<Eigen::Vector3d>& centroids, const Eigen::Vector3d& sensor);
  /// Every `label_every` scans; never where only the map's output needs labels.
  bool labelDue() const;
  /// Labels what has changed since the last labelling. The labels are those that labelling the
  /// whole map would give.
  void label();
  /// Makes the Gaussians of all occupied voxels ready for matching, selected or not.
  void prepareAll();
  void clear();

  int levels() const { return static_cast<int>(occupied_.size()); }
  double voxelSize(int level) const { return voxel_size_ * static_cast<double>(1 << level); }
  bool empty() const { return scans_ == 0; }
  uint32_t scans() const { return scans_; }

  /// 1 <= level < levels()
  const BitGrid<8>& occupied(int level) const { return occupied_[static_cast<size_t>(level)]; }
  /// 1 <= level <= kGaussianLevels
  const GaussianLevel& gaussians(int level) const {
    return gaussians_[static_cast<size_t>(level - 1)];
  }
  /// Voxels of level 0 with at least `min_hits`.
  const BitGrid<16>& hitVoxels() const { return hit_voxels_; }
  const BitGrid<16>& edgeVoxels() const { return edge_voxels_; }
  /// Mean of the centroids that fell in a voxel of level 0; the voxel must have been hit.
  Eigen::Vector3d centroid(const VoxelIndex& v) const;

  size_t ignoredCentroids() const { return ignored_; }
  /// How often a voxel has left hitVoxels(), because later scans saw through it.
  size_t clearedVoxels() const { return cleared_count_; }
  /// What matching needs, packed: bits of all levels and 48 bytes a selected Gaussian.
  size_t packedBytes() const;
  /// What is held while mapping.
  size_t bytes() const;

 private:
  struct Hit {
    std::array<float, 3> sum{};  // from the voxel's centre [m]
    uint32_t count = 0;
    uint32_t last_scan = 0;
    uint32_t hits = 0;
    uint32_t last_pass = 0;  // scan that last saw through it
    uint32_t passes = 0;     // scans that did since the last hit
  };
  struct Sight;

  void addInside(const std::vector<Eigen::Vector3d>& centroids, const Eigen::Vector3d& sensor);
  Eigen::Vector3d centroidOf(uint32_t slot, const VoxelIndex& v) const;
  void addHits(const std::vector<Eigen::Vector3d>& centroids);
  void addMoments(int level, const std::vector<Eigen::Vector3d>& centroids);
  /// A voxel that has its min_hits.
  void selectNew(int level, uint32_t slot);
  void markOccupied(const VoxelIndex& v);
  void clearSeenThrough(const std::vector<Eigen::Vector3d>& centroids,
                        const Eigen::Vector3d& sensor);
  void lookThrough(const Sight& sight, const VoxelIndex& parent);
  bool isSeenThrough(const Sight& sight, uint32_t parent_slot, const Eigen::Vector3d& point) const;
  bool isHit(const VoxelIndex& v) const { return hit_grid_.find(v) != SlotGrid<8>::kNone; }
  bool isHitBeside(const VoxelIndex& v) const;
  void remove(const VoxelIndex& v);
  void subtractMoments(const VoxelIndex& v);
  void sumChildren(int level, const VoxelIndex& v);
  void changeEdges(const BitGrid<16>& targets, const std::vector<BitGrid<16>::Block>& before);
  /// One finer voxel of v's came to be or hold an edge (+1), or no longer does (-1).
  void countEdge(int level, const VoxelIndex& v, int change);
  /// The block of this voxel is due for a choice of anchors.
  void touch(int level, uint32_t slot);
  void chooseAnchorsAnew();
  void selectRandom();
  GaussianLevel& level(int l) { return gaussians_[static_cast<size_t>(l - 1)]; }

  double voxel_size_;
  MapConfig config_;
  EdgeLabeller<16> labeller_;
  int edge_neighbours_;  // see thinEdges()
  uint32_t scans_ = 0;
  size_t ignored_ = 0;
  size_t cleared_count_ = 0;
  SlotGrid<8> hit_grid_;
  Pool<Hit> hits_;
  BitGrid<16> hit_voxels_;
  BitGrid<16> edge_candidates_;  // labelled, not yet thinned
  BitGrid<16> edge_voxels_;
  BitGrid<16> changed_;  // of hit_voxels_, since the last labelling
  std::vector<GaussianLevel> gaussians_;
  std::array<std::vector<uint32_t>, kGaussianLevels> touched_;  // slots by level - 1, repeated
  std::array<double, kGaussianLevels> random_share_{};          // of the voxels of a level
  std::vector<BitGrid<8>> occupied_;                            // [0] is not used
  std::vector<VoxelIndex> voxels_;          // of the scan being added, at level 0
  std::vector<Eigen::Vector3f> to_sensor_;  // of the same, unit vectors
  std::vector<uint32_t> slots_;             // of the same, at one level
  std::vector<VoxelIndex> cleared_;         // by the scan being added
};

/// Centroids of the voxels of level 0, in the order of the voxels [m].
std::vector<Eigen::Vector3f> centroidsOf(const OccupiedVoxelMap& map, const BitGrid<16>& voxels);

}  // namespace edgevox
