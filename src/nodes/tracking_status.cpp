// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/tracking_status.hpp"

#include "nodes/scan_report.hpp"

namespace edgevox {
namespace {

constexpr double kSlowLatency = 0.3;  // [s]

}  // namespace

void TrackingStatus::add(const ScanReport& report) {
  last_ = report;
  ++scans_;
  ++counts_[report.status];
  if (report.odometry_jumped != 0) ++odometry_jumps_;
  if (report.begun_anew != 0) ++begun_anew_;
  if (report.degenerate != 0) ++degenerate_;
  if (report.located) not_located_in_a_row_ = 0;
  if (!report.located && report.status != "paused") ++not_located_in_a_row_;
  if (!report.located) return;
  const StageTimes times = timesOf(report);
  for (size_t i = 0; i < kStages.size(); ++i) {
    const float seconds = times.*kStages[i].time;
    if (seconds > 0) times_[i].add(static_cast<double>(seconds));
  }
  if (report.latency > 0) latency_.add(static_cast<double>(report.latency));
}

void TrackingStatus::summarise(DiagnosticStatus& status) const {
  if (scans_ == 0) {
    status.summary(DiagnosticStatus::OK, "no scan yet");
  } else if (last_.located) {
    status.summaryf(DiagnosticStatus::OK, "%s, hit ratio %.2f", last_.status.c_str(),
                    static_cast<double>(last_.hit_ratio));
  } else if (last_.status == "paused") {
    status.summary(DiagnosticStatus::OK, last_.status);
  } else if (last_.status == "stale" || last_.status == "too_few") {
    status.summary(DiagnosticStatus::WARN, last_.status + ": " + last_.text);
  } else {
    const std::string count = std::to_string(not_located_in_a_row_);
    const std::string word = last_.status == "lost" ? "LOST" : last_.status;
    status.summary(DiagnosticStatus::ERROR, word + " for " + count + " scans: " + last_.text);
  }
  if (!transform_error_.empty()) {
    status.mergeSummary(DiagnosticStatus::ERROR, "no pose on TF: " + transform_error_);
  }
  if (!odometry_error_.empty()) {
    warn("predicted at constant velocity: " + odometry_error_, status);
  }
  if (last_.odometry_jumped != 0) {
    warn(std::string("predicted at constant velocity: ") + odometryJumpText(), status);
  }
  if (last_.begun_anew != 0) warn(begunAnewText(), status);
  if (latency_.quantile(0.5) > kSlowLatency) {
    warn(
        "poses come late: choose a larger voxel_size, fewer matcher/refine_points or a faster "
        "computer",
        status);
  }
}

void TrackingStatus::fill(DiagnosticStatus& status) const {
  summarise(status);
  status.add("scans", scans_);
  for (const auto& [name, count] : counts_) status.add("scans " + name, count);
  status.add("jumps of the odometry", odometry_jumps_);
  status.add("maps begun anew", begun_anew_);
  status.add("scans degenerate", degenerate_);
  status.add("degenerate directions", int{last_.degenerate});
  status.add("hit ratio", last_.hit_ratio);
  status.add("share of the scan in occupied voxels", last_.hit_share);
  status.add("required hit ratio", last_.required_hit_ratio);
  status.add("blocked lines of sight", last_.blocked);
  status.add("most blocked lines of sight", last_.most_blocked);
  status.add("matches", last_.matches);
  status.add("restarts", last_.restarts);
  status.add("clouds refused before", last_.refused);
  status.add("scans dropped in all", last_.dropped);
  for (size_t i = 0; i < times_.size(); ++i) {
    if (!times_[i].empty()) addTimes(kStages[i].name, times_[i], status);
  }
  addTimes("latency", latency_, status);
}

}  // namespace edgevox
