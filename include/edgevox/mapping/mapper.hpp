// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include "edgevox/config.hpp"
#include "edgevox/edges/recent_edges.hpp"
#include "edgevox/grid/voxel.hpp"
#include "edgevox/map/map_builder.hpp"
#include "edgevox/mapping/localizer.hpp"
#include "edgevox/matching/global_search.hpp"
#include "edgevox/scan/voxel_scan.hpp"
#include "edgevox/stage_timer.hpp"
#include "edgevox/tracking/scan_result.hpp"
#include "edgevox/tracking/tracker.hpp"

namespace edgevox {

/// Builds a map from scans in order of time: a Tracker finds where each was taken, a MapBuilder
/// inserts it. A scan that cannot be located changes neither the map nor the pose. In a map that
/// was read from a file a sensor that was not there just now is looked for as by a Localizer.
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

  /// The next scan is looked for near this pose first.
  void lookNear(const Pose& T_map_sensor);
  /// For searches to come; what it points to must outlive them.
  void setControl(const SearchControl& control) { control_ = control; }

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
      self.setGiven(!self.map_.empty());
    }
  }

 private:
  /// Looks for the sensor in the map there is; a copy of the mapper has none.
  struct Finder {
    Finder() = default;
    Finder(const Finder&) {}
    Finder(Finder&&) = default;
    Finder& operator=(Finder&&) = default;

    std::unique_ptr<Localizer> localizer;
  };

  void clockJumped();
  void setGiven(bool given);
  ScanResult locate(const VoxelScan& scan, const ScanPrior& prior);
  ScanResult trackInMap(const VoxelScan& scan, const ScanPrior& prior);
  std::optional<ScanResult> searchInMap(const VoxelScan& scan, const ScanPrior& prior);
  std::optional<ScanResult> lookInMap(const VoxelScan& scan, const ScanPrior& prior);
  void look();
  bool isContradicted() const;

  Config config_;
  Clock clock_;
  Tracker tracker_;
  MapBuilder map_;
  RecentEdges recent_edges_;
  bool is_given_ = false;     // the map: it comes from a file
  bool is_new_here_ = false;  // the sensor: no scan was located in the given map yet
  Finder finder_;
  SearchControl control_;
};

}  // namespace edgevox
