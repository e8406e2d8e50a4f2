// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

#include "edgevox/config.hpp"
#include "edgevox/map/match_map.hpp"
#include "edgevox/scan/voxel_scan.hpp"
#include "edgevox/stage_timer.hpp"
#include "edgevox/tracking/scan_result.hpp"
#include "edgevox/tracking/tracker.hpp"

namespace edgevox {

/// Finds where scans were taken in a map that stays as it is.
class Localizer {
 public:
  /// The first scan is looked for around `T_map_start`.
  Localizer(const Config& config, MatchMap map, const Pose& T_map_start = Pose::Identity(),
            Clock clock = Clock::kProcessCpu);

  ScanResult process(const VoxelScan& scan, const ScanPrior& prior = {});

  const MatchMap& map() const { return map_; }

 private:
  Clock clock_;
  Tracker tracker_;
  MatchMap map_;
};

}  // namespace edgevox
