// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/mapping/localizer.hpp"

namespace edgevox {

Localizer::Localizer(const Config& config, MatchMap map, const Pose& T_map_start, Clock clock)
    : clock_(clock), tracker_(config), map_(std::move(map)) {
  tracker_.setPose(T_map_start);
}

ScanResult Localizer::process(const VoxelScan& scan, const ScanPrior& prior) {
  StageTimer timer(clock_);
  const ClockWatch::Order order = tracker_.checkStamp(scan.stamp);
  if (order == ClockWatch::Order::kLate || order == ClockWatch::Order::kAhead) {
    return tracker_.stale(scan, order == ClockWatch::Order::kAhead);
  }
  ScanResult result = tracker_.track(scan, prior, {map_});
  result.clock_jumped = order == ClockWatch::Order::kJumpedBack;
  result.times.match = static_cast<float>(timer.lap());
  return result;
}

}  // namespace edgevox
