// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/mapping/localizer.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace edgevox {
namespace {

constexpr size_t kMostHypotheses = 8;
constexpr uint64_t kLostHypothesis = 2;  // scans in a row

bool isUnusable(ClockWatch::Order order) {
  return order == ClockWatch::Order::kLate || order == ClockWatch::Order::kAhead;
}

template <typename Match>
void takeFit(const Match& match, ScanResult& result) {
  result.hit_ratio = match.hit_ratio;
  result.hit_share = match.hit_share;
  result.blocked = match.blocked;
}

}  // namespace

Localizer::Localizer(const Config& config, MatchMap map, Clock clock)
    : Localizer(config, std::move(map), Tracker(config), clock) {}

Localizer::Localizer(const Config& config, MatchMap map, Tracker tracker, Clock clock)
    : config_(config),
      clock_(clock),
      tracker_(std::move(tracker)),
      map_(std::move(map)),
      recent_edges_(config.voxel_size, config.edges, config.mapper.edge_window, config.threads),
      search_(map_, config) {}

void Localizer::lookNear(const Pose& T_map_sensor) {
  lookEverywhere();
  around_ = SearchRegion::near(T_map_sensor);
}

void Localizer::lookEverywhere() {
  looks_ = true;
  around_.reset();
  hypotheses_.clear();
  last_search_ = {};
  recent_edges_.clear();
}

std::vector<Pose> Localizer::candidates() const {
  std::vector<Pose> poses;
  if (!looks_) return poses;
  for (const Hypothesis& hypothesis : hypotheses_) {
    poses.push_back(hypothesis.tracker.T_map_sensor());
  }
  if (!poses.empty()) return poses;
  for (const MatchResult& answer : last_search_.answers) poses.push_back(answer.T_map_sensor);
  return poses;
}

ScanResult Localizer::process(const VoxelScan& scan, const ScanPrior& prior) {
  StageTimer timer(clock_);
  const ClockWatch::Order order = tracker_.checkStamp(scan.stamp);
  if (isUnusable(order)) return tracker_.stale(scan, order == ClockWatch::Order::kAhead);
  ScanResult result = locate(scan, prior);
  result.clock_jumped = result.clock_jumped || order == ClockWatch::Order::kJumpedBack;
  result.times.match = static_cast<float>(timer.lap());
  return result;
}

ScanResult Localizer::locate(const VoxelScan& scan, const ScanPrior& prior) {
  ScanResult result = looks_ ? look(scan, prior) : tracker_.track(scan, prior, {map_});
  const auto search_after = static_cast<uint64_t>(config_.localizer.search_after);
  if (!looks_ && search_after > 0 && tracker_.lostInARow() >= search_after) lookEverywhere();
  if (result.located()) recent_edges_.add(tracker_.placed(scan));
  return result;
}

ScanResult Localizer::look(const VoxelScan& scan, const ScanPrior& prior) {
  if (const auto fault = tracker_.faultOf(scan)) return tracker_.notLocated(scan, *fault);
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
  const bool cancelled = last_search_.outcome == SearchOutcome::kCancelled;
  result.refusal = cancelled ? Refusal::kCancelled : Refusal::kNotFound;
  if (!last_search_.answers.empty()) takeFit(last_search_.answers.front(), result);
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
  ClockWatch::Order order = ClockWatch::Order::kInTime;
  for (Hypothesis& hypothesis : hypotheses_) order = hypothesis.tracker.checkStamp(scan.stamp);
  if (isUnusable(order)) return tracker_.stale(scan, order == ClockWatch::Order::kAhead);
  if (order == ClockWatch::Order::kJumpedBack) {
    lookEverywhere();
    ScanResult result = search(scan, prior, std::nullopt);
    result.clock_jumped = true;
    return result;
  }
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
    ScanResult result = tracker_.notLocated(scan, ScanStatus::kLost);
    result.refusal = Refusal::kNotFound;
    return result;
  }
  if (hypotheses_.size() > 1) {
    ScanResult result = tracker_.notLocated(scan, ScanStatus::kAmbiguous);
    takeFit(hypotheses_.front().result, result);
    return result;
  }
  tracker_ = hypotheses_.front().tracker;
  const ScanResult result = hypotheses_.front().result;
  hypotheses_.clear();
  looks_ = false;
  return result;
}

}  // namespace edgevox
