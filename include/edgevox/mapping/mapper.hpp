// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "edgevox/config.hpp"
#include "edgevox/edges/recent_edges.hpp"
#include "edgevox/grid/voxel.hpp"
#include "edgevox/map/map_builder.hpp"
#include "edgevox/scan/voxel_scan.hpp"
#include "edgevox/stage_timer.hpp"
#include "edgevox/tracking/scan_result.hpp"
#include "edgevox/tracking/tracker.hpp"

namespace edgevox {

/// Builds a map from scans in order of time: a Tracker finds where each was taken, a MapBuilder
/// inserts it. A scan that cannot be located changes neither the map nor the pose.
class Mapper {
 public:
  explicit Mapper(const Config& config, Clock clock = Clock::kProcessCpu);

  /// track(), then insert() if the scan was located.
  ScanResult process(const VoxelScan& scan, const ScanPrior& prior = {});
  /// Where the scan was taken: all of the result but the times of insert(). The map is as before,
  /// or cleared as the clock has jumped back or as nothing fits a young one.
  ScanResult track(const VoxelScan& scan, const ScanPrior& prior = {});
  /// Adds the scan that track() has just located to the map, and the times that takes to its
  /// result.
  void insert(const VoxelScan& scan, ScanResult& result);

  /// A copy is cheap, see MapBuilder.
  const MapBuilder& map() const { return map_; }
  /// The edges of the last located scan, by it and those before it.
  const RecentEdges& recentEdges() const { return recent_edges_; }
  /// Brings the labels up to date, for output.
  void finishLabels() { map_.label(); }
  /// Forgets map and motion; the next scan is the first.
  void reset();

  /// All but the recent edges.
  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.tracker_, self.map_);
    if constexpr (Archive::kReads) {
      self.recent_edges_.clear();
      self.is_given_ = !self.map_.empty();
    }
  }

 private:
  void clockJumped();
  ScanResult trackInMap(const VoxelScan& scan, const ScanPrior& prior);
  ScanResult searchInMap(const VoxelScan& scan, const ScanPrior& prior, const ScanResult& lost);
  bool isContradicted() const;

  Config config_;
  Clock clock_;
  Tracker tracker_;
  MapBuilder map_;
  RecentEdges recent_edges_;
  bool is_given_ = false;  // the map: it comes from a file
};

}  // namespace edgevox
