// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/mapping/mapper.hpp"

#include <utility>

namespace edgevox {
namespace {

constexpr uint32_t kYoung = 3;         // scans, from which on two have confirmed the first
constexpr uint64_t kSearchEvery = 10;  // scans

}  // namespace

Mapper::Mapper(const Config& config, Clock clock)
    : config_(config),
      clock_(clock),
      tracker_(config),
      map_(config.voxel_size, config.map, config.edges, config.threads, config.voxelizer.max_range),
      recent_edges_(config.voxel_size, config.edges, config.mapper.edge_window, config.threads) {}

ScanResult Mapper::process(const VoxelScan& scan, const ScanPrior& prior) {
  ScanResult result = track(scan, prior);
  if (result.located()) insert(scan, result);
  return result;
}

ScanResult Mapper::track(const VoxelScan& scan, const ScanPrior& prior) {
  StageTimer timer(clock_);
  const ClockWatch::Order order = tracker_.checkStamp(scan.stamp);
  if (order == ClockWatch::Order::kLate || order == ClockWatch::Order::kAhead) {
    return tracker_.stale(scan, order == ClockWatch::Order::kAhead);
  }
  const bool clock_jumped = order == ClockWatch::Order::kJumpedBack;
  if (clock_jumped) clockJumped();
  if (around_ && !map_.empty()) findInMap(scan, prior, around_);
  around_.reset();
  ScanResult result = trackInMap(scan, prior);
  if (result.status == ScanStatus::kLost && isContradicted()) {
    const bool odometry_jumped = result.odometry_jumped;
    reset();
    result = trackInMap(scan, prior);
    result.odometry_jumped = odometry_jumped;
    result.begun_anew = true;
  }
  if (isSearchDue()) result = searchInMap(scan, prior, result);
  if (result.located()) is_new_here_ = false;
  if (is_new_here_) ++lost_here_;
  result.clock_jumped = clock_jumped;
  result.times.match = static_cast<float>(timer.lap());
  return result;
}

ScanResult Mapper::trackInMap(const VoxelScan& scan, const ScanPrior& prior) {
  return tracker_.track(
      scan, prior, {map_.matchMap(), map_.empty(), map_.scans(), [this] { map_.prepareAll(); }});
}

/// Of a sensor that is lost for long.
ScanResult Mapper::searchInMap(const VoxelScan& scan, const ScanPrior& prior,
                               const ScanResult& lost) {
  Tracker before = tracker_;
  if (!findInMap(scan, prior, std::nullopt)) return lost;
  ScanResult result = trackInMap(scan, prior);
  result.odometry_jumped = lost.odometry_jumped;
  if (result.located()) return result;
  tracker_ = std::move(before);
  return lost;
}

/// Puts the tracker where the sensor is found.
bool Mapper::findInMap(const VoxelScan& scan, const ScanPrior& prior,
                       const std::optional<SearchRegion::Around>& around) {
  const SearchResult found =
      tracker_.search(scan, prior, GlobalSearch(map_.matchMap(), config_), around, control_);
  if (found.outcome != SearchOutcome::kFound) return false;
  tracker_.setPose(found.answers.front().T_map_sensor);
  return true;
}

/// In a given map at once, and again now and then until the sensor is found there.
bool Mapper::isSearchDue() const {
  const uint64_t lost = tracker_.lostInARow();
  if (lost == 0) return false;
  if (is_new_here_) return lost_here_ % kSearchEvery == 0;
  const auto every = static_cast<uint64_t>(config_.mapper.search_after);
  return every > 0 && lost % every == 0;
}

void Mapper::lookNear(const Pose& T_map_sensor) { around_ = SearchRegion::near(T_map_sensor); }

/// Whether more scans speak against a young map than for it: its first ones were bad, not those
/// that do not fit.
bool Mapper::isContradicted() const {
  return !is_given_ && map_.scans() < kYoung && tracker_.lostInARow() > map_.scans();
}

void Mapper::clockJumped() {
  if (config_.mapper.after_clock_jump == AfterClockJump::kClearMap) {
    reset();
  } else {
    recent_edges_.clear();
  }
}

void Mapper::insert(const VoxelScan& scan, ScanResult& result) {
  StageTimer timer(clock_);
  std::vector<Eigen::Vector3d> centroids = tracker_.placed(scan);
  map_.add(centroids, tracker_.sensor());
  recent_edges_.add(std::move(centroids));
  result.times.insert = static_cast<float>(timer.lap());
  if (map_.labelDue()) map_.label();
  result.times.label = static_cast<float>(timer.lap());
}

void Mapper::setGiven(bool given) {
  is_given_ = given;
  is_new_here_ = given;
  lost_here_ = 0;
}

void Mapper::reset() {
  map_.clear();
  recent_edges_.clear();
  tracker_.reset();
  setGiven(false);
}

}  // namespace edgevox
