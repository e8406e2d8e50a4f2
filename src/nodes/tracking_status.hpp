// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <edgevox/ScanReport.h>

#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "edgevox/stage_times.hpp"
#include "nodes/diagnostics.hpp"

namespace edgevox {

/// What the diagnostics tell of tracking: how the last scans went, and what to do if they went
/// badly.
class TrackingStatus {
 public:
  void add(const ScanReport& report);
  void setTransformError(const std::string& error) { transform_error_ = error; }
  void setOdometryError(const std::string& error) { odometry_error_ = error; }

  /// Fills all but the input and the map.
  void fill(DiagnosticStatus& status) const;

 private:
  void summarise(DiagnosticStatus& status) const;

  ScanReport last_;
  uint64_t scans_ = 0;
  uint64_t not_located_in_a_row_ = 0;
  uint64_t odometry_jumps_ = 0;
  uint64_t begun_anew_ = 0;
  uint64_t degenerate_ = 0;                 // scans
  std::map<std::string, uint64_t> counts_;  // scans by status
  std::string transform_error_;
  std::string odometry_error_;
  std::array<RollingTimes, kStages.size()> times_;  // of the stages
  RollingTimes latency_;
};

}  // namespace edgevox
