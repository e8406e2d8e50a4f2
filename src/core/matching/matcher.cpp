// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/matching/matcher.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Eigenvalues>

#include "core/matching/correspondences.hpp"
#include "core/matching/discrete_search.hpp"
#include "core/matching/one_answer.hpp"
#include "core/matching/open_directions.hpp"
#include "core/matching/symmetric6.hpp"
#include "edgevox/matching/free_space.hpp"
#include "edgevox/scan/motion.hpp"
#include "edgevox/statistics.hpp"

namespace edgevox {
namespace {

constexpr int kCandidates = 4;  // for each point refined: most have no anchor beside them
constexpr uint64_t kMostLookUps = 12000000;  // of a match; four times what a found one needed
constexpr double kTrustedStep = 1.0;         // of a refinement alone [voxel of level 1]
constexpr double kNearStep = 0.25;           // after which other points may be near [voxel]
constexpr double kLeastKnown = 0.25;         // of a sample
constexpr int kKnownLevel = 3;
constexpr int kStepsFromFar = 80;         // of a refinement, where the prediction is ...
constexpr double kFarSigma = 0.5;         // ... less sure than this [m]
constexpr double kWidest = 16.0;          // of the squared kernel of a refinement
constexpr double kNarrowing = 0.25;       // of that, each step
constexpr double kSharpSigma = 0.02;      // of a prediction that needs no wider kernel [m]
constexpr double kLeastAgreement = 0.12;  // of a match from an unsure guess
constexpr double kComparable = 0.9;       // coarse score of a restart, of the best one
constexpr double kAlike = 0.98;           // hit ratio of another answer, of the best one
constexpr double kSameStart = 0.25;       // of what is one answer, of starts that lead to one
constexpr double kInflation = 6.0;        // the inverse information underestimates the scatter
constexpr double kLeastInformation = kInflation / (1.0 * 1.0);  // of a pose: 1 m, 1 rad
constexpr double kLargestMove = 10.0;                           // of one step [m, rad]
constexpr double kConvergedDistance = 5e-4;                     // [m]
constexpr double kConvergedAngle = 5e-5;                        // [rad]

/// Whether the pose is in the grid's range and the points of the sample, seen from there, have
/// indices of voxels.
bool isInGridRange(const MatchMap& map, const ScanSample& sample, const Pose& pose) {
  const double size = map.voxelSize(0);
  return inGridRange(pose, size) &&
         std::all_of(sample.begin(), sample.end(),
                     [=](const Eigen::Vector3d& point) { return inGridRange(point, size); });
}

/// How far a change of pose moves the sensor, or a point at `range` around it.
double largestStep(const Pose& from, const Pose& to, double range) {
  const Pose change = from.inverse() * to;
  return std::max(change.translation().norm(), rotationAngle(change) * range);
}

Move difference(const Pose& to, const Pose& from) {
  Move move;
  move << to.translation() - from.translation(),
      rotationVector(to.linear() * from.linear().transpose());
  return move;
}

Matrix6 covarianceOf(const Matrix6& information) {
  const Matrix6 covariance = kInflation * inverseOf(information);
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace

Prediction Prediction::withCovariance(const Pose& T_map_sensor, const Matrix6& covariance,
                                      bool measured) {
  return {T_map_sensor, kInflation * inverseOf(covariance), measured};
}

double Prediction::sigma() const {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(information.topLeftCorner<3, 3>(),
                                                              Eigen::EigenvaluesOnly);
  return std::sqrt(kInflation / std::max(solver.eigenvalues()[0], kLeastInformation));
}

double medianRange(const ScanSample& sample, size_t count) {
  std::vector<double> ranges(count);
  for (size_t i = 0; i < count; ++i) ranges[i] = sample[i].norm();
  return upperMedian(std::move(ranges));
}

size_t Matcher::sampleSize() const {
  return static_cast<size_t>(std::max(config_.search_points, kCandidates * config_.refine_points));
}

size_t Matcher::refinePoints(const ScanSample& sample) const {
  return std::min(sample.size(), static_cast<size_t>(config_.refine_points));
}

MatchResult Matcher::match(const MatchMap& map, const ScanSample& sample,
                           const MatchRequest& request) const {
  MatchResult result = align(map, sample, request);
  if (result.accepted() && !isDoubtful(request, result)) return result;
  if (!isInGridRange(map, sample, request.guess.T_map_sensor)) return result;
  restart(map, sample, request, result);
  return result;
}

/// The refinement alone where the guess was good, else the better fit of that and the search.
MatchResult Matcher::align(const MatchMap& map, const ScanSample& sample,
                           const MatchRequest& request) const {
  const Pose& guess = request.guess.T_map_sensor;
  MatchResult result;
  result.T_map_sensor = guess;
  if (!isInGridRange(map, sample, guess)) return result;
  if (config_.mode == MatcherMode::kPublished) {
    DiscreteSearch search(map, sample, static_cast<size_t>(config_.search_points));
    result.T_map_sensor = search.climbAsPublished(guess);
    return verified(map, sample, request, result);
  }
  const double unsure = request.guess.sigma() / kSharpSigma;
  result = refineFrom(map, sample, request, guess, std::clamp(unsure * unsure, 1.0, kWidest));
  const double step =
      largestStep(guess, result.T_map_sensor, medianRange(sample, refinePoints(sample)));
  if (result.accepted() && result.hit_ratio >= request.trusted_hit_ratio &&
      step < kTrustedStep * map.voxelSize(1)) {
    return result;
  }
  DiscreteSearch search(map, sample, static_cast<size_t>(config_.search_points));
  MatchResult searched = refineFrom(map, sample, request, search.climb(guess), kWidest);
  result.look_ups = searched.look_ups += result.look_ups + search.lookUps();
  if (!searched.accepted() && result.accepted()) return result;
  if (searched.accepted() && !result.accepted()) return searched;
  return searched.fit > result.fit ? searched : result;
}

MatchResult Matcher::refineFrom(const MatchMap& map, const ScanSample& sample,
                                const MatchRequest& request, const Pose& start,
                                double widening) const {
  Refinement refinement;
  refinement.start = start;
  refinement.predicted = request.guess;
  refinement.widening = widening;
  if (request.guess.sigma() > kFarSigma) refinement.steps = kStepsFromFar;
  refinement.all_voxels = request.all_voxels;
  refinement.compares = request.doubtful;
  return verified(map, sample, request, refine(map, sample, refinement));
}

MatchResult Matcher::verified(const MatchMap& map, const ScanSample& sample,
                              const MatchRequest& request, MatchResult result) const {
  if (!inGridRange(result.T_map_sensor, map.voxelSize(0))) return result;
  const Pose moved = request.guess.T_map_sensor.inverse() * result.T_map_sensor;
  const double distance = moved.translation().norm();
  const double angle = rotationAngle(moved);
  const bool far = distance > request.far_translation || angle > request.far_rotation;
  result.required_hit_ratio = far ? request.far_hit_ratio : request.required_hit_ratio;
  const Hits found = hits(map, sample, refinePoints(sample), result.T_map_sensor);
  result.hit_ratio = found.ratio;
  result.hit_share = found.share;
  const bool trusted = !far && result.hit_ratio >= request.trusted_hit_ratio;
  result.most_blocked = trusted ? request.most_blocked_near : request.most_blocked;
  result.blocked = blockedShare(map, sample, kLinesOfSight, result.T_map_sensor);
  if (distance > request.max_translation || angle > request.max_rotation) {
    result.refusal = Refusal::kTooFar;
  } else if (result.hit_ratio < result.required_hit_ratio) {
    result.refusal = Refusal::kFewHits;
  } else if (result.agreement < kLeastAgreement) {
    result.refusal = Refusal::kDisagrees;
  } else {
    result.refusal = result.blocked > result.most_blocked ? Refusal::kBlocked : Refusal::kNone;
  }
  return result;
}

/// Goes on when one is accepted: whether it is the only answer is part of it. In open directions
/// there are answers all along, of which the prediction chooses one.
void Matcher::restart(const MatchMap& map, const ScanSample& sample, const MatchRequest& request,
                      MatchResult& best) const {
  DiscreteSearch few(map, sample, static_cast<size_t>(config_.restart_points));
  DiscreteSearch all(map, sample, static_cast<size_t>(config_.search_points));
  const auto hits = [&](const Pose& pose) { return few.hits(DiscreteSearch::kFinestLevel, pose); };
  const RestartPoses starts = restartPoses(map, sample, request.guess.T_map_sensor, request.reach,
                                           request.seed, static_cast<size_t>(config_.max_restarts));
  std::vector<Pose> climbed;
  std::vector<MatchResult> answers;
  if (best.accepted()) answers.push_back(best);
  uint64_t others = best.look_ups + starts.look_ups;
  const auto lookUps = [&] { return others + few.lookUps() + all.lookUps(); };
  int best_hits = hits(best.T_map_sensor);
  int restarts = 0;
  for (const Pose& start : starts.best) {
    if (lookUps() > kMostLookUps) break;
    ++restarts;
    const Pose found = few.climb(start, starts.level);
    const auto isFound = [&](const Pose& other) {
      return areNear(found, other, kSameStart * kSameTranslation, kSameStart * kSameRotation);
    };
    if (hits(found) < kComparable * best_hits ||
        std::any_of(climbed.begin(), climbed.end(), isFound)) {
      continue;
    }
    climbed.push_back(found);
    const Pose finer = all.climb(found, starts.level);
    const MatchResult candidate = refineFrom(map, sample, request, finer, kWidest);
    others += candidate.look_ups;
    if (candidate.accepted()) answers.push_back(candidate);
    if (std::pair(candidate.accepted(), candidate.hit_ratio) <=
        std::pair(best.accepted(), best.hit_ratio)) {
      continue;
    }
    best = candidate;
    best_hits = hits(best.T_map_sensor);
  }
  best.restarts = restarts;
  best.look_ups = lookUps();
  const bool ambiguous = std::any_of(answers.begin(), answers.end(), [&](const MatchResult& other) {
    return other.hit_ratio > kAlike * best.hit_ratio &&
           !areOneAnswer(best.T_map_sensor, other.T_map_sensor);
  });
  if (ambiguous && best.degeneracy.directions == 0) best.refusal = Refusal::kAmbiguous;
}

MatchResult Matcher::refine(const MatchMap& map, const ScanSample& sample,
                            const Refinement& refinement) const {
  MatchResult result;
  Pose& pose = result.T_map_sensor;
  pose = refinement.start;
  const size_t wanted = refinePoints(sample);
  if (wanted == 0) return result;
  const double range = medianRange(sample, wanted);
  const Prediction& predicted = refinement.predicted;
  Correspondences near(map, sample, wanted, refinement.all_voxels);
  std::optional<OpenDirections> open;
  Matrix6 prior = Matrix6::Zero();
  Pose near_pose;
  double widening = refinement.widening;
  for (int step = 0; step < refinement.steps; ++step) {
    if (!open || largestStep(near_pose, pose, range) > kNearStep * map.voxelSize(1)) {
      near.find(pose);
      near_pose = pose;
      open.emplace(near.geometry(pose, range), range);
      prior = (predicted.measured ? open->within(predicted.information) : predicted.information) +
              kLeastInformation * Matrix6::Identity();
    }
    const NormalEquations all = near.linearise(pose, widening);
    const NormalEquations closed = open->without(all);
    const NormalEquations& equations = predicted.measured ? closed : all;
    result.look_ups = near.lookUps();
    result.matches = all.matches;
    result.information = closed.h;
    result.degeneracy = open->degeneracy();
    result.fit = all.weight / static_cast<double>(wanted);
    if (all.matches < 6) break;
    const Move off = difference(pose, predicted.T_map_sensor);
    const Move move = -solutionOf(equations.h + prior, equations.b + prior * off);
    if (!(move.cwiseAbs().maxCoeff() < kLargestMove)) break;  // NaN
    pose = apply(pose, move);
    if (!inGridRange(pose, map.voxelSize(0))) break;
    if (widening <= 1.0 && move.head<3>().norm() < kConvergedDistance &&
        move.tail<3>().norm() < kConvergedAngle) {
      break;
    }
    widening = std::max(1.0, widening * kNarrowing);
  }
  result.covariance = covarianceOf(result.information + prior);
  if (refinement.compares && inGridRange(pose, map.voxelSize(0))) {
    result.agreement = agreementOf(near.geometry(pose, range), near.fittingGeometry(pose, range));
  }
  renormalise(pose);
  return result;
}

Hits Matcher::hits(const MatchMap& map, const ScanSample& sample, size_t points,
                   const Pose& T_map_sensor) {
  const size_t count = std::min(sample.size(), points);
  if (count == 0) return {};
  DiscreteSearch search(map, sample, count);
  const auto all = static_cast<double>(count);
  const int hits = search.hits(1, T_map_sensor);
  const int known = search.hits(std::min(kKnownLevel, map.levels() - 1), T_map_sensor);
  return {hits / all, hits / std::max(static_cast<double>(known), kLeastKnown * all)};
}

double worstSigma(const Matrix6& information, double range) {
  Matrix6 scaled = information;  // on (translation, rotation * range)
  scaled.topRightCorner<3, 3>() /= range;
  scaled.bottomLeftCorner<3, 3>() /= range;
  scaled.bottomRightCorner<3, 3>() /= range * range;
  const double least = eigenOf(scaled).values[0];
  return least > 0 ? 1.0 / std::sqrt(least) : std::numeric_limits<double>::infinity();
}

}  // namespace edgevox
