// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/mapper.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "scan_sample.hpp"

namespace edgevox {
namespace {

constexpr size_t kFewestVoxels = 50;
constexpr double kVarianceInflation = 6.0;  // the inverse information underestimates the scatter
constexpr double kTrusted = 0.95;           // of the running median of the hit ratios
constexpr double kLongestReach = 4.0;
constexpr double kFarthest = 2.0;                      // a match from its prediction [m]
constexpr double kFastest = 10.0;                      // the same, of the time passed [m/s]
constexpr double kWidest = 60.0 * M_PI / 180.0;        // [rad]
constexpr double kFastestTurn = 180.0 * M_PI / 180.0;  // [rad/s]
constexpr double kLongestExtrapolation = 2.0;          // of the motion [s]
constexpr double kLeastInterval = 1e-3;                // of two sweeps' middles [s]
constexpr double kTwistGain = 0.5;  // half an interval from the mean velocity to the sweep

ScanSample deskewed(const VoxelScan& scan, const std::vector<size_t>& positions,
                    const Deskew& deskew) {
  ScanSample sample(positions.size());
  for (size_t i = 0; i < sample.size(); ++i) sample[i] = deskew(scan.voxels[positions[i]]);
  return sample;
}

Matrix6 covarianceOf(const Matrix6& information) {
  return kVarianceInflation * information.inverse();
}

}  // namespace

const char* name(ScanStatus status) {
  switch (status) {
    case ScanStatus::kFirst:
      return "first";
    case ScanStatus::kTracked:
      return "tracked";
    case ScanStatus::kFallback:
      return "fallback";
    case ScanStatus::kLost:
      return "lost";
    case ScanStatus::kStale:
      return "stale";
    case ScanStatus::kTooFew:
      return "too_few";
    case ScanStatus::kTooLarge:
      return "too_large";
  }
  return "";
}

void RunningMedian::add(double value) {
  if (values_.size() < kWindow) {
    values_.push_back(value);
  } else {
    values_[next_] = value;
  }
  next_ = (next_ + 1) % kWindow;
}

double RunningMedian::median() const {
  std::vector<double> sorted = values_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

Mapper::Mapper(const Config& config, Clock clock)
    : config_(config),
      clock_(clock),
      clock_watch_(config.mapper.clock_jump, config.mapper.clock_leap),
      matcher_(config.matcher),
      map_(config.voxel_size, config.matcher.coarsest_voxel, config.map, config.edges,
           config.threads),
      recent_edges_(config.voxel_size, config.edges, config.mapper.edge_window, config.threads) {}

ScanResult Mapper::process(const VoxelScan& scan, const ScanPrior& prior) {
  StageTimer timer(clock_);
  ScanResult result;
  result.number = scan.number;
  result.stamp = scan.stamp;
  result.T_map_sensor = T_map_sensor_;
  const ClockWatch::Order order = clock_watch_.check(scan.stamp);
  if (order == ClockWatch::Order::kLate || order == ClockWatch::Order::kAhead) {
    result.status = ScanStatus::kStale;
    result.ahead = order == ClockWatch::Order::kAhead;
    return result;
  }
  if (order == ClockWatch::Order::kJumpedBack) {
    result.clock_jumped = true;
    config_.mapper.after_clock_jump == AfterClockJump::kClearMap ? reset() : forgetMotion();
    result.T_map_sensor = T_map_sensor_;
  }
  if (!scan.too_large.empty() ||
      scan.voxels.size() > static_cast<size_t>(config_.voxelizer.max_voxels)) {
    result.status = ScanStatus::kTooLarge;
    return result;
  }
  if (scan.voxels.size() < kFewestVoxels) {
    result.status = ScanStatus::kTooFew;
    return result;
  }
  const SweepTime sweep = sweepTime(scan);
  Located now{scan.stamp + sweep.middle(), firstPose(prior), prior.T_odom_sensor};
  if (last_ && !(now.time - last_->time >= kLeastInterval)) {
    result.status = ScanStatus::kStale;
    return result;
  }
  if (map_.empty()) {
    result.status = ScanStatus::kFirst;
  } else {
    align(scan, sweep, now, result);
  }
  result.times.match = timer.lap();
  if (!result.located()) {
    ++lost_in_a_row_;
    return result;
  }
  lost_in_a_row_ = 0;
  clock_watch_.accept(scan.stamp);
  advance(scan, now);
  result.T_map_sensor = T_map_sensor_;
  insert(scan, sweep, result);
  return result;
}

/// UTM coordinates, for example, are too far from their origin for a grid.
Pose Mapper::firstPose(const ScanPrior& prior) const {
  Pose pose = prior.T_map_first;
  if (!inGridRange(pose, config_.voxel_size / 2)) pose.translation().setZero();
  return pose;
}

void Mapper::forgetMotion() {
  clock_watch_.reset();
  last_.reset();
  twist_ = {};
  twist_in_sweep_ = {};
  recent_edges_.clear();
}

/// Deskews by the predicted motion, matches; once more by the motion that the match has shown.
void Mapper::align(const VoxelScan& scan, const SweepTime& sweep, Located& now,
                   ScanResult& result) {
  const auto positions = sampleVoxels(scan, matcher_.sampleSize());
  const Pose guess = predict(now);
  const bool has_odom = last_ && now.T_odom_sensor && last_->T_odom_sensor;
  Twist twist = has_odom ? twistTo(now.time, guess) : twist_in_sweep_;
  const MatchResult found =
      locate(deskewed(scan, positions, {sweep, twist}), guess, now.time, result);
  if (!found.accepted) return;
  now.T_map_sensor = found.T_map_sensor;
  if (sweep.instant() || config_.matcher.mode == MatcherMode::kPublished) return;
  if (last_) twist = twistInSweep(twistTo(now.time, now.T_map_sensor));
  const auto refined = matcher_.refine(map_.matchMap(), deskewed(scan, positions, {sweep, twist}),
                                       now.T_map_sensor, 1, result.status == ScanStatus::kFallback);
  if (!inGridRange(refined.T_map_sensor, config_.voxel_size)) return;  // it ran away
  now.T_map_sensor = refined.T_map_sensor;
  result.covariance = covarianceOf(refined.information);
}

/// Takes `now` as the place of the sensor and updates the motion.
void Mapper::advance(const VoxelScan& scan, const Located& now) {
  T_map_sensor_ = now.T_map_sensor;
  if (last_) {
    const Twist twist = twistTo(now.time, now.T_map_sensor);
    twist_in_sweep_ = twistInSweep(twist);
    T_map_sensor_ = last_->T_map_sensor * moved(twist, scan.stamp - last_->time);
    twist_ = twist;
  }
  last_ = now;
}

Pose Mapper::predict(const Located& now) const {
  if (!last_) return T_map_sensor_;
  if (now.T_odom_sensor && last_->T_odom_sensor) {
    return last_->T_map_sensor * last_->T_odom_sensor->inverse() * *now.T_odom_sensor;
  }
  if (lost_in_a_row_ > 1) return last_->T_map_sensor;
  const double seconds = std::min(now.time - last_->time, kLongestExtrapolation);
  return last_->T_map_sensor * moved(twist_, seconds);
}

/// The velocity in the middle of the sweep, from the mean ones before it and before that.
Twist Mapper::twistInSweep(const Twist& twist) const {
  return {twist.linear + kTwistGain * (twist.linear - twist_.linear),
          twist.angular + kTwistGain * (twist.angular - twist_.angular)};
}

Twist Mapper::twistTo(double time, const Pose& T_map_sensor) const {
  return twistOf(last_->T_map_sensor.inverse() * T_map_sensor, time - last_->time);
}

MatchResult Mapper::locate(const ScanSample& sample, const Pose& guess, double time,
                           ScanResult& result) {
  const double since_last = last_ ? time - last_->time : 0.0;
  MatchRequest request;
  request.guess = guess;
  request.required_hit_ratio = requiredHitRatio();
  request.trusted_hit_ratio = trustedHitRatio();
  request.reach = std::min(1.0 + static_cast<double>(lost_in_a_row_), kLongestReach);
  request.far_hit_ratio =
      hit_ratios_.empty() ? request.required_hit_ratio : request.trusted_hit_ratio;
  request.farthest = kFarthest + kFastest * since_last;
  request.widest = kWidest + kFastestTurn * since_last;
  request.seed = uint64_t{map_.scans()} << 32 | lost_in_a_row_;
  const double range = medianRange(sample, matcher_.refinePoints(sample));
  const bool published = config_.matcher.mode == MatcherMode::kPublished;

  result.status = ScanStatus::kTracked;
  MatchResult match = matcher_.align(map_.matchMap(), sample, request);
  const double sigma = worstSigma(match.information, range);
  if (!match.accepted || (!published && needsFallback(match, sigma))) {
    result.status = ScanStatus::kFallback;
    request.all_voxels = true;
    map_.prepareAll();
    match = matcher_.match(map_.matchMap(), sample, request);
  }
  if (match.accepted) {
    hit_ratios_.add(match.hit_ratio);
    if (!published) sigmas_.add(sigma);
    if (!published) result.covariance = covarianceOf(match.information);
  } else {
    result.status = ScanStatus::kLost;
  }
  result.hit_ratio = match.hit_ratio;
  result.required_hit_ratio = request.required_hit_ratio;
  result.matches = match.matches;
  result.restarts = match.restarts;
  return match;
}

bool Mapper::needsFallback(const MatchResult& match, double sigma) const {
  const MapperConfig& c = config_.mapper;
  return match.matches < c.fallback_matches ||
         (!hit_ratios_.empty() && match.hit_ratio < c.fallback_hit_ratio * hit_ratios_.median()) ||
         (!sigmas_.empty() && sigma > c.fallback_sigma * sigmas_.median());
}

double Mapper::requiredHitRatio() const {
  const MatcherConfig& c = config_.matcher;
  return hit_ratios_.empty() ? c.min_hit_ratio : c.relative_hit_ratio * hit_ratios_.median();
}

double Mapper::trustedHitRatio() const {
  return hit_ratios_.empty() ? 1.0 : kTrusted * hit_ratios_.median();
}

void Mapper::insert(const VoxelScan& scan, const SweepTime& sweep, ScanResult& result) {
  StageTimer timer(clock_);
  const Deskew deskew(sweep, twist_in_sweep_);
  const Pose& T_map_sensor = last_->T_map_sensor;
  std::vector<Eigen::Vector3d> centroids(scan.voxels.size());
  std::transform(
      scan.voxels.begin(), scan.voxels.end(), centroids.begin(),
      [&](const ScanVoxel& voxel) -> Eigen::Vector3d { return T_map_sensor * deskew(voxel); });
  map_.add(centroids, T_map_sensor.translation());
  recent_edges_.add(std::move(centroids));
  result.times.insert = timer.lap();
  if (map_.labelDue()) map_.label();
  result.times.label = timer.lap();
}

void Mapper::reset() {
  map_.clear();
  forgetMotion();
  T_map_sensor_ = Pose::Identity();
  lost_in_a_row_ = 0;
  hit_ratios_ = {};
  sigmas_ = {};
}

}  // namespace edgevox
