// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/tracking/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/scan/scan_sample.hpp"

namespace edgevox {
namespace {

constexpr size_t kFewestVoxels = 50;
constexpr double kLongestReach = 4.0;
constexpr double kMaxTranslation = 2.0;    // a match from its prediction [m]
constexpr double kFastestChange = 10.0;    // the same, of the time passed, of a known motion [m/s]
constexpr double kRadians = M_PI / 180.0;  // in a degree
constexpr double kMaxRotation = 60.0 * kRadians;  // [rad]
constexpr int kStepsDeskewed = 11;  // of the refinement, after the motion in the sweep is known
constexpr double kLeastInterval = 1e-3;  // of two sweeps' middles [s]

struct Sigma {
  double translation;  // [m]
  double rotation;     // [rad]
};

/// Standard deviation of a step from pose to pose.
struct StepNoise {
  Sigma least;
  Sigma acceleration;  // by the half of the squared time [1/s^2]
  double drift;        // of the way, and of the angle
};
constexpr StepNoise kConstantVelocity{{0.01, 0.003}, {2.0, 2.0}, 0.05};
constexpr StepNoise kOdometry{{0.005, 0.003}, {0.0, 0.0}, 0.03};

ScanSample deskewed(const VoxelScan& scan, const std::vector<size_t>& positions,
                    const Deskew& deskew) {
  ScanSample sample(positions.size());
  for (size_t i = 0; i < sample.size(); ++i) sample[i] = deskew(scan.voxels[positions[i]]);
  return sample;
}

Matrix6 covarianceOf(const Pose& step, double seconds, const StepNoise& noise) {
  const double half_square = 0.5 * seconds * seconds;
  const double translation = noise.least.translation +
                             noise.acceleration.translation * half_square +
                             noise.drift * step.translation().norm();
  const double rotation = noise.least.rotation + noise.acceleration.rotation * half_square +
                          noise.drift * rotationAngle(step);
  Vector6 sigma;
  sigma << Eigen::Vector3d::Constant(translation), Eigen::Vector3d::Constant(rotation);
  return sigma.cwiseAbs2().asDiagonal();
}

}  // namespace

Tracker::Tracker(const Config& config)
    : config_(config),
      clock_watch_(config.mapper.clock_jump, config.mapper.clock_leap),
      odometry_watch_(config.mapper.max_speed, config.mapper.max_turn * kRadians),
      matcher_(config.matcher),
      acceptance_(config.matcher, config.mapper) {}

ClockWatch::Order Tracker::checkStamp(double stamp) {
  const ClockWatch::Order order = clock_watch_.check(stamp);
  if (order != ClockWatch::Order::kJumpedBack) return order;
  forgetMotion();
  clock_watch_.accept(stamp);
  return order;
}

ScanResult Tracker::track(const VoxelScan& scan, const ScanPrior& prior,
                          const TrackedMap& tracked) {
  ScanResult result = notLocated(scan, ScanStatus::kLost);
  result.odometry_jumped = !odometry_watch_.add(scan.stamp, prior.T_odom_sensor);
  const auto refused = [&](ScanStatus status) {
    result.status = status;
    return result;
  };
  if (const auto fault = faultOf(scan)) return refused(*fault);
  const SweepTime sweep = sweepTime(scan);
  SweepPose now{scan.stamp + sweep.middle(), firstPose(prior)};
  if (motion_.known() && !(now.time - motion_.last().time >= kLeastInterval)) {
    return refused(ScanStatus::kStale);
  }
  if (tracked.empty) {
    result.status = ScanStatus::kFirst;
  } else {
    align(scan, sweep, tracked, now, result);
  }
  lost_in_a_row_ = result.located() ? 0 : lost_in_a_row_ + 1;
  if (!result.located()) return result;
  clock_watch_.accept(scan.stamp);
  motion_.add(now, scan.stamp);
  covariance_ = result.covariance;
  odometry_watch_.located(motion_.velocity());
  result.T_map_sensor = T_map_sensor();
  return result;
}

ScanResult Tracker::stale(const VoxelScan& scan, bool ahead) const {
  ScanResult result = notLocated(scan, ScanStatus::kStale);
  result.ahead = ahead;
  return result;
}

ScanResult Tracker::notLocated(const VoxelScan& scan, ScanStatus status) const {
  ScanResult result;
  result.status = status;
  result.number = scan.number;
  result.stamp = scan.stamp;
  result.T_map_sensor = T_map_sensor();
  return result;
}

SearchResult Tracker::search(const VoxelScan& scan, const ScanPrior& prior,
                             const GlobalSearch& search,
                             const std::optional<SearchRegion::Around>& around,
                             const SearchControl& control) const {
  if (faultOf(scan)) return {};
  SearchRegion region;
  region.R_level_sensor = prior.T_odom_sensor.value_or(prior.T_map_first).linear();
  region.tilt = config_.search.tilt * kRadians;
  region.around = around;
  const auto positions = sampleVoxels(scan, matcher_.sampleSize());
  return search.search(deskewed(scan, positions, {sweepTime(scan), Twist()}), region, control);
}

double Tracker::secondsSinceLocated(double stamp) const {
  return motion_.known() ? stamp - motion_.last().time : std::numeric_limits<double>::infinity();
}

std::optional<ScanStatus> Tracker::faultOf(const VoxelScan& scan) const {
  const auto most = static_cast<size_t>(config_.voxelizer.max_voxels);
  if (!scan.too_large.empty() || scan.voxels.size() > most) return ScanStatus::kTooLarge;
  if (scan.voxels.size() < kFewestVoxels) return ScanStatus::kTooFew;
  return std::nullopt;
}

/// UTM coordinates, for example, are too far from their origin for a grid.
Pose Tracker::firstPose(const ScanPrior& prior) const {
  Pose pose = prior.T_map_first;
  if (!inGridRange(pose, config_.voxel_size / 2)) pose.translation().setZero();
  return pose;
}

/// Deskews by the predicted motion, matches; once more by the motion that the match has shown.
void Tracker::align(const VoxelScan& scan, const SweepTime& sweep, const TrackedMap& tracked,
                    SweepPose& now, ScanResult& result) {
  const auto positions = sampleVoxels(scan, matcher_.sampleSize());
  const Prediction predicted = predict(now.time);
  Twist twist = motion_.predictTwist({now.time, predicted.T_map_sensor},
                                     odometry_watch_.sinceLocated().has_value());
  const MatchResult found = locate(deskewed(scan, positions, {sweep, twist}),
                                   requestFor(now, predicted, tracked.version), tracked, result);
  if (!found.accepted()) return;
  now.T_map_sensor = found.T_map_sensor;
  if (sweep.instant() || config_.matcher.mode == MatcherMode::kPublished) return;
  if (motion_.known()) twist = motion_.twistInSweepAt(now);
  Matcher::Refinement refinement;
  refinement.start = now.T_map_sensor;
  refinement.predicted = predicted;
  refinement.steps = kStepsDeskewed;
  refinement.all_voxels = result.status == ScanStatus::kFallback;
  const auto refined =
      matcher_.refine(tracked.map, deskewed(scan, positions, {sweep, twist}), refinement);
  if (!inGridRange(refined.T_map_sensor, config_.voxel_size)) return;  // it ran away
  now.T_map_sensor = refined.T_map_sensor;
  result.covariance = refined.covariance;
  result.degeneracy = refined.degeneracy;
}

/// Sure as the last pose and what has come since. Of a sensor whose motion is not known nothing is
/// predicted: it is looked for where it was.
Prediction Tracker::predict(double time) const {
  const auto step = odometry_watch_.sinceLocated();
  const Pose pose = motion_.predict(time, step, goesOn());
  if (!step && !(goesOn() && motion_.velocity())) return {pose, Matrix6::Zero(), false};
  const Matrix6 since = step ? covarianceOf(*step, 0.0, kOdometry)
                             : covarianceOf(motion_.last().T_map_sensor.inverse() * pose,
                                            time - motion_.last().time, kConstantVelocity);
  Prediction predicted = Prediction::withCovariance(pose, covariance_ + since, step.has_value());
  predicted.step_sigma = std::sqrt(since(0, 0));
  return predicted;
}

MatchRequest Tracker::requestFor(const SweepPose& now, const Prediction& predicted,
                                 uint32_t version) const {
  const double since_last = motion_.known() ? now.time - motion_.last().time : 0.0;
  MatchRequest request;
  request.guess = predicted;
  const bool blind = !predicted.measured && (!motion_.known() || !goesOn());
  acceptance_.setLimits(lost_in_a_row_, blind, request);
  request.reach = std::min(1.0 + static_cast<double>(lost_in_a_row_), kLongestReach);
  request.max_translation = kMaxTranslation + fastestChange() * since_last;
  request.max_rotation = kMaxRotation + config_.mapper.max_turn * kRadians * since_last;
  request.seed = uint64_t{version} << 32 | lost_in_a_row_;
  return request;
}

/// How fast the sensor may leave the predicted pose [m/s].
double Tracker::fastestChange() const {
  const double max_speed = config_.mapper.max_speed;
  const bool predicted = motion_.velocity() || odometry_watch_.sinceLocated();
  return predicted ? std::min(kFastestChange, max_speed) : max_speed;
}

/// Aligns to the selected surfaces; where that is not convincing, to all.
MatchResult Tracker::locate(const ScanSample& sample, const MatchRequest& request,
                            const TrackedMap& tracked, ScanResult& result) {
  const bool published = config_.matcher.mode == MatcherMode::kPublished;
  result.status = ScanStatus::kTracked;
  MatchResult match = matcher_.align(tracked.map, sample, request);
  const double sigma =
      worstSigma(match.information, medianRange(sample, matcher_.refinePoints(sample)));
  const bool weak = isDoubtful(request, match) || acceptance_.needsFallback(match, sigma);
  if (!match.accepted() || (!published && weak)) {
    result.status = ScanStatus::kFallback;
    MatchRequest of_all = request;
    of_all.all_voxels = true;
    tracked.prepareAll();
    match = matcher_.match(tracked.map, sample, of_all);
  }
  if (match.accepted()) {
    acceptance_.addHitRatio(match.hit_ratio);
    acceptance_.addBlocked(match.blocked);
    if (!published) acceptance_.addSigma(sigma);
    result.covariance = match.covariance;
    result.degeneracy = match.degeneracy;
  } else {
    result.status =
        match.refusal == Refusal::kAmbiguous ? ScanStatus::kAmbiguous : ScanStatus::kLost;
  }
  result.hit_ratio = match.hit_ratio;
  result.hit_share = match.hit_share;
  result.required_hit_ratio = match.required_hit_ratio;
  result.blocked = match.blocked;
  result.most_blocked = match.most_blocked;
  result.refusal = match.refusal;
  result.matches = match.matches;
  result.restarts = match.restarts;
  return match;
}

std::vector<Eigen::Vector3d> Tracker::placed(const VoxelScan& scan) const {
  const Deskew deskew(sweepTime(scan), motion_.twistInSweep());
  const Pose& T_map_sensor = motion_.last().T_map_sensor;
  std::vector<Eigen::Vector3d> centroids(scan.voxels.size());
  std::transform(
      scan.voxels.begin(), scan.voxels.end(), centroids.begin(),
      [&](const ScanVoxel& voxel) -> Eigen::Vector3d { return T_map_sensor * deskew(voxel); });
  return centroids;
}

void Tracker::setPose(const Pose& T_map_sensor) {
  odometry_watch_.forget();
  motion_.set(T_map_sensor);
  covariance_.setZero();
  lost_in_a_row_ = 0;
}

void Tracker::forgetMotion() {
  clock_watch_.reset();
  odometry_watch_.forget();
  motion_.forget();
  covariance_.setZero();
}

void Tracker::reset() { *this = Tracker(config_); }

}  // namespace edgevox
