// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "edgevox/config.hpp"
#include "edgevox/edges/edge_extractor.hpp"
#include "edgevox/grid/block_grid.hpp"
#include "edgevox/grid/pool.hpp"
#include "edgevox/grid/slots.hpp"
#include "edgevox/grid/voxel.hpp"
#include "edgevox/map/far_regions.hpp"
#include "edgevox/map/lone_voxels.hpp"
#include "edgevox/map/match_map.hpp"
#include "edgevox/map/moment_level.hpp"

namespace edgevox {

/// Keeps a MatchMap up to date with scans: counts the hits of voxels, sums up their centroids,
/// labels edges on the accumulated occupancy, and selects the voxels that scans are matched to.
/// A copy is a snapshot: it shares what neither has changed since (see Pool) and takes a
/// millisecond or two for a million voxels. It may be used and destroyed in another thread while
/// its origin goes on; only while it is made must the origin stand still.
class MapBuilder {
 public:
  /// `voxel_size` [m] is that of level 0; map.coarsest_voxel fixes the number of levels. No point
  /// lies farther from its sensor than `max_range` [m].
  MapBuilder(double voxel_size, const MapConfig& map, const EdgeConfig& edges, int threads,
             double max_range = VoxelizerConfig{}.max_range);

  /// add(), then label() when it is due.
  void insert(const std::vector<Eigen::Vector3d>& centroids, const Eigen::Vector3d& sensor);
  /// Adds one scan's centroids, seen from `sensor`, in the map frame [m]; those out of the grid's
  /// range are ignored and counted, those that stand alone wait for a second hit. Takes out the
  /// voxels that `clear_after` scans have seen through. Freezes the regions that have been out of
  /// reach for `freeze_after` scans, and thaws those that the scan changes.
  void add(const std::vector<Eigen::Vector3d>& centroids, const Eigen::Vector3d& sensor);
  /// Whether it is time to label: every `label_every` scans, never where only the map's output
  /// needs labels.
  bool labelDue() const;
  /// Labels what has changed since the last labelling. The labels are those that labelling the
  /// whole map would give.
  void label();
  /// Makes the surfaces of all occupied voxels ready for matching, selected or not.
  void prepareAll();
  void clear();

  const MatchMap& matchMap() const { return match_map_; }
  /// The same with its edges and hit voxels: to save, to draw, to convert. label() comes first.
  MatchMap completeMap() const;
  int levels() const { return match_map_.levels(); }
  double voxelSize(int level) const { return match_map_.voxelSize(level); }
  bool empty() const { return scans_ == 0; }
  uint32_t scans() const { return scans_; }

  /// What the surfaces of level 1 are computed from.
  const MomentLevel& moments() const { return moments_; }
  /// Voxels of level 0 with at least `min_hits`: a copy, as those of frozen regions are packed.
  BitGrid<16> hitVoxels() const;
  size_t hitVoxelCount() const { return match_map_.hitVoxels().voxelCount() + frozenVoxels(); }
  const BitGrid<16>& edgeVoxels() const { return match_map_.edgeVoxels(); }
  /// Mean of the centroids that fell in a voxel of level 0, which must be in hitVoxels(); in frozen
  /// regions that of an edge voxel to 1/256 of its size, of any other its centre.
  Eigen::Vector3d centroid(const VoxelIndex& v) const;

  size_t ignoredCentroids() const { return ignored_; }
  /// Centroids left out because they stand alone and have not been confirmed.
  size_t loneCentroids() const { return left_out_lone_; }
  /// Centroids left out because the map is as large as `memory`.
  size_t centroidsPastMemory() const { return left_out_full_; }
  /// Whether the map was as large as `memory` when the last scan was added.
  bool isFull() const { return full_; }
  /// How often a voxel has left hitVoxels(), because later scans saw through it.
  size_t clearedVoxels() const { return cleared_count_; }
  /// The number of frozen regions: cubes of 32 voxels of which only what matching needs is kept.
  size_t frozenRegions() const { return far_.frozenCount(); }
  /// The number of voxels of hitVoxels() in them.
  size_t frozenVoxels() const { return far_.frozenVoxels(); }
  /// How often a region has come back.
  size_t thawedRegions() const { return thawed_count_; }
  /// Size of what is held while mapping.
  size_t bytes() const;

  /// All of its state: a map that is read goes on as the one written would have.
  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.scans_, self.ignored_, self.cleared_count_, self.left_out_lone_, self.left_out_full_,
          self.full_, self.thawed_count_, self.lone_voxels_, self.hit_grid_, self.hits_,
          self.hit_slots_, self.match_map_.hitVoxels(), self.edge_candidates_, self.changed_,
          self.match_map_, self.far_, self.random_share_, self.moments_, self.touched_);
    if constexpr (Archive::kReads) self.checkRead();
  }

 private:
  struct Hit {
    std::array<float, 3> sum{};  // from the voxel's centre [m]
    uint32_t count = 0;
    uint32_t last_scan = 0;
    uint32_t hits = 0;
    uint32_t last_pass = 0;  // scan that last saw through it
    uint32_t passes = 0;     // scans that did since the last hit

    template <typename Self, typename Archive>
    static void archive(Self& self, Archive& bytes) {
      bytes(self.sum, self.count, self.last_scan, self.hits, self.last_pass, self.passes);
    }
  };
  struct Ray;
  /// What lasts while a scan is added: a copy of the map has none of it.
  struct ScanBeingAdded {
    ScanBeingAdded() = default;
    ScanBeingAdded(const ScanBeingAdded&) {}
    ScanBeingAdded(ScanBeingAdded&&) = default;
    ScanBeingAdded& operator=(ScanBeingAdded&&) = default;

    std::vector<Eigen::Vector3d> centroids;
    std::vector<VoxelIndex> voxels;          // at level 0
    std::vector<Eigen::Vector3f> to_sensor;  // unit vectors
    std::vector<uint32_t> slots;             // of its hits, then of its moments
    std::vector<VoxelIndex> cleared;         // by the scan
    ScanNeighbours neighbours;
  };

  void checkRead();
  void checkHits();
  void checkSurfaces() const;
  /// Makes the centroids and voxels of scan_, of those in range.
  void setPoints(const std::vector<Eigen::Vector3d>& centroids);
  /// Leaves in scan_ the points whose voxel passes the test, in their order.
  template <typename Test>
  void keepPoints(const Test& test);
  void leaveOutLone();
  void leaveOutNew();
  bool isBesideEstablished(const VoxelIndex& parent) const;
  bool isFrozen(const VoxelIndex& v) const;
  /// Whether there is a hit voxel in one of level 1, in a region that is not frozen.
  bool isHitWithin(const VoxelIndex& parent) const;
  void addPoints(const Eigen::Vector3d& sensor);
  Eigen::Vector3d centroidOf(uint32_t slot, const VoxelIndex& v) const;
  /// The slot of a voxel in hits_, which is made if there is none.
  uint32_t hitSlot(const VoxelIndex& v);
  void dropHit(uint32_t slot);
  void addHits();
  void addMoments();
  /// A voxel that has its min_hits.
  void selectNew(uint32_t slot);
  /// Fits planes to the blocks in which the scan has changed surfaces.
  void fitPlanes();
  void fitPlanes(const VoxelIndex& block);
  void markOccupied(const VoxelIndex& v);
  void clearSeenThrough(const Eigen::Vector3d& sensor);
  void lookThrough(const Ray& ray, const VoxelIndex& parent);
  bool isSeenThrough(const Ray& ray, uint32_t parent_slot, const Eigen::Vector3d& point) const;
  bool isHit(const VoxelIndex& v) const { return hit_grid_.find(v) != SlotGrid<8>::kNone; }
  bool isHitBeside(const VoxelIndex& v) const;
  void remove(const VoxelIndex& v);
  void subtractMoments(const VoxelIndex& v);
  void changeEdges(const BitGrid<16>& targets, const std::vector<BitGrid<16>::Block>& before);
  /// Of the voxels in one of level 1 others are edges than before.
  void countEdges(const VoxelIndex& parent);
  /// The block of this voxel is due for a choice of what is selected.
  void touch(uint32_t slot);
  void chooseAnchorsAnew();
  void selectRandom();
  void selectEdges();
  void freezeFar(const Eigen::Vector3d& sensor);
  bool freezeDue() const;
  void freezeAll(const std::vector<VoxelIndex>& regions);
  void freeze(const VoxelIndex& region);
  void packVoxels(const VoxelIndex& region, FrozenRegion& frozen);
  void dropHits(const VoxelIndex& region);
  void packCells(const VoxelIndex& region, std::vector<PackedCell>& packed);
  /// Thaws the regions that a change of voxel v concerns.
  void thawAround(const VoxelIndex& v);
  void thaw(const VoxelIndex& region);
  void reviveHit(const VoxelIndex& v, const Eigen::Vector3d& in_voxel);
  void unpackCells(const VoxelIndex& region, const PackedCell* next);
  Eigen::Vector3d frozenCentroid(const VoxelIndex& v) const;
  void checkFrozen(const VoxelIndex& region, const FrozenRegion& frozen) const;
  /// Size of what is held less what will be used again.
  size_t usedBytes() const;
  /// As configured.
  size_t memoryBytes() const { return static_cast<size_t>(config_.memory) * 1000000; }
  void select(uint32_t slot, bool selected) {
    moments_.select(slot, selected, match_map_.surfaces());
  }

  double voxel_size_;
  double max_range_;
  MapConfig config_;
  EdgeLabeller<16> labeller_;
  int edge_neighbours_;  // see thinEdges()
  uint32_t scans_ = 0;
  size_t ignored_ = 0;
  size_t cleared_count_ = 0;
  size_t left_out_lone_ = 0;
  size_t left_out_full_ = 0;
  size_t thawed_count_ = 0;
  bool full_ = false;
  RecentVoxels lone_voxels_;
  SlotGrid<8> hit_grid_;
  Pool<Hit> hits_;
  Slots hit_slots_;
  BitGrid<16> edge_candidates_;  // labelled, not yet thinned
  BitGrid<16> changed_;          // of the hit voxels, since the last labelling
  MomentLevel moments_;
  MatchMap match_map_;
  FarRegions far_;
  std::vector<uint32_t> touched_;  // slots of moments_, repeated
  double random_share_ = 0.0;      // of its voxels that are selected
  ScanBeingAdded scan_;
};

/// Says that a map is as large as it may be, and what to do.
std::string fullText(const MapConfig& config);

template <typename Test>
void MapBuilder::keepPoints(const Test& test) {
  size_t kept = 0;
  for (size_t i = 0; i < scan_.voxels.size(); ++i) {
    if (!test(scan_.voxels[i])) continue;
    scan_.voxels[kept] = scan_.voxels[i];
    scan_.centroids[kept++] = scan_.centroids[i];
  }
  scan_.voxels.resize(kept);
  scan_.centroids.resize(kept);
}

/// Centroids of the voxels of level 0, in the order of the voxels [m].
std::vector<Eigen::Vector3f> centroidsOf(const MapBuilder& map, const BitGrid<16>& voxels);

}  // namespace edgevox
