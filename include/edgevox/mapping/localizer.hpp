// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "edgevox/config.hpp"
#include "edgevox/edges/recent_edges.hpp"
#include "edgevox/grid/voxel.hpp"
#include "edgevox/map/match_map.hpp"
#include "edgevox/matching/global_search.hpp"
#include "edgevox/ring_buffer.hpp"
#include "edgevox/scan/voxel_scan.hpp"
#include "edgevox/stage_timer.hpp"
#include "edgevox/tracking/scan_result.hpp"
#include "edgevox/tracking/tracker.hpp"

namespace edgevox {

/// Finds where scans were taken in a map that stays as it is: looks for the sensor, near a pose or
/// everywhere, follows it, and looks for it again when it is lost for long. Where several poses fit
/// alike, all are followed until one is left.
class Localizer {
 public:
  /// The first scan is looked for everywhere.
  Localizer(const Config& config, MatchMap map, Clock clock = Clock::kProcessCpu);
  /// The same for a sensor that `tracker` has lost.
  Localizer(const Config& config, MatchMap map, Tracker tracker, Clock clock);

  ScanResult process(const VoxelScan& scan, const ScanPrior& prior = {});
  /// process() of a scan whose stamp is in time; without its times.
  ScanResult locate(const VoxelScan& scan, const ScanPrior& prior);

  /// The next scan is looked for near this pose, and if it is not there, everywhere.
  void lookNear(const Pose& T_map_sensor);
  /// The next scan is looked for everywhere.
  void lookEverywhere();
  bool isLooking() const { return looks_; }
  /// It looks, and several poses fit alike.
  bool isComparing() const { return !hypotheses_.empty(); }

  const MatchMap& map() const { return map_; }
  /// Of the sensor where it is found.
  const Tracker& tracker() const { return tracker_; }
  /// The edges of the last located scan, by it and those before it.
  const RecentEdges& recentEdges() const { return recent_edges_; }
  /// Where the sensor may be, of a sensor that is looked for: T_map_sensor of the poses that are
  /// compared, else what the last search has found to fit best.
  std::vector<Pose> candidates() const;
  /// For searches to come; what it points to must outlive them.
  void setControl(const SearchControl& control) { control_ = control; }

 private:
  static constexpr size_t kWindow = 5;  // scans by which poses are compared

  /// The sensor, if it is at one of several poses that fit alike.
  struct Hypothesis {
    Tracker tracker;
    ScanResult result;  // of the last scan
    RingBuffer<double> evidence{kWindow};

    double meanEvidence() const;
  };

  ScanResult look(const VoxelScan& scan, const ScanPrior& prior);
  ScanResult search(const VoxelScan& scan, const ScanPrior& prior,
                    const std::optional<SearchRegion::Around>& around);
  ScanResult compare(const VoxelScan& scan, const ScanPrior& prior);
  void follow(const VoxelScan& scan, const ScanPrior& prior, Hypothesis& hypothesis) const;

  Config config_;
  Clock clock_;
  Tracker tracker_;
  MatchMap map_;
  RecentEdges recent_edges_;
  GlobalSearch search_;
  SearchControl control_;
  SearchResult last_search_;
  bool looks_ = true;
  std::optional<SearchRegion::Around> around_;  // where it looks first
  std::vector<Hypothesis> hypotheses_;
};

}  // namespace edgevox
