// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/mapping/mapper.hpp"

#include <utility>

namespace edgevox {
namespace {

constexpr uint32_t kYoung = 3;     // scans, from which on two have confirmed the first
constexpr double kLongAgo = 10.0;  // the sensor may have been moved since [s]

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
  ScanResult result = locate(scan, prior);
  if (result.located()) is_new_here_ = false;
  result.clock_jumped = clock_jumped;
  result.times.match = static_cast<float>(timer.lap());
  return result;
}

ScanResult Mapper::locate(const VoxelScan& scan, const ScanPrior& prior) {
  if (is_new_here_ && !(tracker_.secondsSinceLocated(scan.stamp) <= kLongAgo) &&
      !finder_.localizer) {
    look();
  }
  if (const auto found = lookInMap(scan, prior)) return *found;
  ScanResult result = trackInMap(scan, prior);
  if (result.status != ScanStatus::kLost && result.status != ScanStatus::kAmbiguous) return result;
  if (result.status == ScanStatus::kLost && isContradicted()) {
    const bool odometry_jumped = result.odometry_jumped;
    reset();
    result = trackInMap(scan, prior);
    result.odometry_jumped = odometry_jumped;
    result.begun_anew = true;
  } else if (is_new_here_) {
    look();
  } else if (auto found = searchInMap(scan, prior)) {
    found->odometry_jumped = result.odometry_jumped;
    return *found;
  }
  return result;
}

/// Of a sensor that is looked for. None if it is to be tracked as before: where somebody has told
/// its place in a map that is being built, one scan decides, unless poses are to be compared.
std::optional<ScanResult> Mapper::lookInMap(const VoxelScan& scan, const ScanPrior& prior) {
  if (!finder_.localizer) return std::nullopt;
  Localizer& finder = *finder_.localizer;
  finder.setControl(control_);
  const ScanResult result = finder.locate(scan, prior);
  if (result.located()) {
    tracker_ = finder.tracker();
    finder_ = {};
    return result;
  }
  if (is_new_here_ || finder.isComparing() || tracker_.faultOf(scan) || control_.isCancelled()) {
    return result;
  }
  finder_ = {};
  return std::nullopt;
}

ScanResult Mapper::trackInMap(const VoxelScan& scan, const ScanPrior& prior) {
  return tracker_.track(
      scan, prior, {map_.matchMap(), map_.empty(), map_.scans(), [this] { map_.prepareAll(); }});
}

/// Of a sensor that is lost for long, if that is asked for; nothing is changed if it is not found.
std::optional<ScanResult> Mapper::searchInMap(const VoxelScan& scan, const ScanPrior& prior) {
  const auto every = static_cast<uint64_t>(config_.mapper.search_after);
  if (every == 0 || tracker_.lostInARow() % every != 0) return std::nullopt;
  const SearchResult found =
      tracker_.search(scan, prior, GlobalSearch(map_.matchMap(), config_), std::nullopt, control_);
  if (found.outcome != SearchOutcome::kFound) return std::nullopt;
  Tracker before = tracker_;
  tracker_.setPose(found.answers.front().T_map_sensor);
  const ScanResult result = trackInMap(scan, prior);
  if (result.located()) return result;
  tracker_ = std::move(before);
  return std::nullopt;
}

void Mapper::look() {
  map_.prepareAll();
  finder_.localizer = std::make_unique<Localizer>(config_, map_.matchMap(), tracker_, clock_);
}

void Mapper::lookNear(const Pose& T_map_sensor) {
  if (map_.empty()) return;
  look();
  finder_.localizer->lookNear(T_map_sensor);
}

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
    if (finder_.localizer) look();
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
  finder_ = {};
}

void Mapper::reset() {
  map_.clear();
  recent_edges_.clear();
  tracker_.reset();
  setGiven(false);
}

}  // namespace edgevox
