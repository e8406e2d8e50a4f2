// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/tracking/acceptance.hpp"

#include <algorithm>
#include <cmath>

#include "edgevox/statistics.hpp"

namespace edgevox {
namespace {

constexpr double kTrusted = 0.95;         // of the running median of the hit ratios
constexpr double kMoreEachLost = 0.005;   // of it, with each lost scan without a guess
constexpr size_t kFewest = 4;             // scans, until when it is not known what is usual
constexpr double kUnsure = 0.25;          // standard deviation of a predicted step [m]
constexpr double kVeryUnsure = 0.5;       // the same
constexpr double kLeastUnsure = 0.75;     // of the running median, of a match from such a step
constexpr double kLeastVeryUnsure = 0.8;  // the same
constexpr double kFarTranslation = 1.0;   // from the prediction [m]
constexpr double kFarUnsure = 0.5;        // the same, after an unsure step
constexpr double kFarRotation = 20.0 * M_PI / 180.0;  // [rad]
constexpr double kMostBlockedAtFirst = 0.2;           // lines of sight, before there is a history
constexpr double kBlocked = 0.08;                     // the same later, more than ...
constexpr double kBlockedNear = 0.15;  // and so much more of a match near the prediction
constexpr double kTimesBlocked = 2.5;  // ... so many times their running median

}  // namespace

/// Before there is a history, a match is not trusted.
void Acceptance::setLimits(uint64_t lost_in_a_row, bool blind, MatchRequest& request) const {
  if (hit_ratios_.empty()) {
    request.required_hit_ratio = matcher_.min_hit_ratio;
    request.far_hit_ratio = matcher_.min_hit_ratio;
    request.trusted_hit_ratio = 1.0;
    request.most_blocked = request.most_blocked_near = kMostBlockedAtFirst;
    return;
  }
  const double usual = upperMedian(hit_ratios_.values());
  request.trusted_hit_ratio = kTrusted * usual;
  request.far_hit_ratio = request.trusted_hit_ratio;
  const bool known = hit_ratios_.values().size() >= kFewest;
  const bool strict = blind && known;
  if (strict) {
    const double more = kMoreEachLost * static_cast<double>(lost_in_a_row);
    request.far_hit_ratio = std::min(1.0, kTrusted + more) * usual;
  }
  const double step_sigma = request.guess.step_sigma;
  request.doubtful = step_sigma > kUnsure;
  double least = matcher_.relative_hit_ratio;
  if (request.doubtful) least = std::max(kLeastUnsure, least);
  if (step_sigma > kVeryUnsure) least = std::max(kLeastVeryUnsure, least);
  request.required_hit_ratio =
      strict ? request.far_hit_ratio : std::max(least * usual, matcher_.min_hit_ratio);
  request.far_translation = request.doubtful && known ? kFarUnsure : kFarTranslation;
  request.far_rotation = kFarRotation;
  request.most_blocked = kBlocked + kTimesBlocked * upperMedian(blocked_.values());
  request.most_blocked_near = request.most_blocked + (lost_in_a_row > 0 ? 0.0 : kBlockedNear);
}

bool Acceptance::needsFallback(const MatchResult& match, double sigma) const {
  if (hit_ratios_.empty() || sigmas_.empty() || match.matches < mapper_.fallback_matches)
    return true;
  return match.hit_ratio < mapper_.fallback_hit_ratio * upperMedian(hit_ratios_.values()) ||
         !(sigma <= mapper_.fallback_sigma * upperMedian(sigmas_.values()));
}

}  // namespace edgevox
