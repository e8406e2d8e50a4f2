// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/mapping/localizer.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace edgevox {
namespace {

constexpr double kNearDistance = 3.0;              // along each axis [m]
constexpr double kNearTurn = 60.0 * M_PI / 180.0;  // [rad]
constexpr size_t kMostHypotheses = 8;
constexpr uint64_t kLostHypothesis = 2;  // scans in a row

}  // namespace

Localizer::Localizer(const Config& config, MatchMap map, Clock clock)
    : config_(config),
      clock_(clock),
      tracker_(config),
      map_(std::move(map)),
      search_(map_, config) {}

void Localizer::lookNear(const Pose& T_map_sensor) {
  lookEverywhere();
  around_ = SearchRegion::Around{T_map_sensor, kNearDistance, kNearTurn};
}

void Localizer::lookEverywhere() {
  looks_ = true;
  around_.reset();
  hypotheses_.clear();
}

ScanResult Localizer::process(const VoxelScan& scan, const ScanPrior& prior) {
  StageTimer timer(clock_);
  const ClockWatch::Order order = tracker_.checkStamp(scan.stamp);
  if (order == ClockWatch::Order::kLate || order == ClockWatch::Order::kAhead) {
    return tracker_.stale(scan, order == ClockWatch::Order::kAhead);
  }
  ScanResult result = looks_ ? look(scan, prior) : tracker_.track(scan, prior, {map_});
  const auto search_after = static_cast<uint64_t>(config_.localizer.search_after);
  if (!looks_ && search_after > 0 && tracker_.lostInARow() >= search_after) lookEverywhere();
  result.clock_jumped = order == ClockWatch::Order::kJumpedBack;
  result.times.match = static_cast<float>(timer.lap());
  return result;
}

ScanResult Localizer::look(const VoxelScan& scan, const ScanPrior& prior) {
  if (!hypotheses_.empty()) return compare(scan, prior);
  if (around_) {
    const ScanResult result = search(scan, prior, around_);
    if (last_search_.outcome != SearchOutcome::kNotFound) return result;
  }
  return search(scan, prior, std::nullopt);
}

ScanResult Localizer::search(const VoxelScan& scan, const ScanPrior& prior,
                             const std::optional<SearchRegion::Around>& around) {
  last_search_ = tracker_.search(scan, prior, search_, around, control_);
  if (last_search_.outcome == SearchOutcome::kFound) {
    tracker_.setPose(last_search_.answers.front().T_map_sensor);
    const ScanResult result = tracker_.track(scan, prior, {map_});
    looks_ = !result.located();
    return result;
  }
  ScanResult result = tracker_.notLocated(scan, ScanStatus::kLost);
  if (!last_search_.answers.empty()) {
    const MatchResult& best = last_search_.answers.front();
    result.hit_ratio = best.hit_ratio;
    result.hit_share = best.hit_share;
    result.blocked = best.blocked;
  }
  if (last_search_.outcome != SearchOutcome::kAmbiguous) return result;
  result.status = ScanStatus::kAmbiguous;
  for (const MatchResult& answer : last_search_.answers) {
    if (hypotheses_.size() == kMostHypotheses) break;
    Hypothesis hypothesis{tracker_, {}};
    hypothesis.tracker.setPose(answer.T_map_sensor);
    follow(scan, prior, hypothesis);
    hypotheses_.push_back(std::move(hypothesis));
  }
  return result;
}

void Localizer::follow(const VoxelScan& scan, const ScanPrior& prior,
                       Hypothesis& hypothesis) const {
  hypothesis.result = hypothesis.tracker.track(scan, prior, {map_});
  hypothesis.evidence.push(hypothesis.result.located() ? evidenceOf(hypothesis.result) : 0.0);
}

double Localizer::Hypothesis::meanEvidence() const {
  const std::vector<double>& values = evidence.values();
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Drops what does not fit any more, or less well than the best over a few scans.
ScanResult Localizer::compare(const VoxelScan& scan, const ScanPrior& prior) {
  double best = 0.0;
  for (Hypothesis& hypothesis : hypotheses_) {
    follow(scan, prior, hypothesis);
    best = std::max(best, hypothesis.meanEvidence());
  }
  const double least = leastAlike(best, config_.search);
  const auto isOut = [&](const Hypothesis& hypothesis) {
    return hypothesis.meanEvidence() < least || hypothesis.tracker.lostInARow() >= kLostHypothesis;
  };
  hypotheses_.erase(std::remove_if(hypotheses_.begin(), hypotheses_.end(), isOut),
                    hypotheses_.end());
  if (hypotheses_.empty()) {
    lookEverywhere();
    return tracker_.notLocated(scan, ScanStatus::kLost);
  }
  if (hypotheses_.size() > 1) return tracker_.notLocated(scan, ScanStatus::kAmbiguous);
  tracker_ = hypotheses_.front().tracker;
  const ScanResult result = hypotheses_.front().result;
  hypotheses_.clear();
  looks_ = false;
  return result;
}

}  // namespace edgevox
