// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/tracking/acceptance.hpp"

#include "edgevox/statistics.hpp"

namespace edgevox {
namespace {

constexpr double kTrusted = 0.95;  // of the running median of the hit ratios

}  // namespace

/// Before there is a history, a match is not trusted.
void Acceptance::setHitRatios(MatchRequest& request) const {
  if (hit_ratios_.empty()) {
    request.required_hit_ratio = matcher_.min_hit_ratio;
    request.far_hit_ratio = matcher_.min_hit_ratio;
    request.trusted_hit_ratio = 1.0;
    return;
  }
  const double usual = upperMedian(hit_ratios_.values());
  request.required_hit_ratio = matcher_.relative_hit_ratio * usual;
  request.trusted_hit_ratio = kTrusted * usual;
  request.far_hit_ratio = request.trusted_hit_ratio;
}

bool Acceptance::needsFallback(const MatchResult& match, double sigma) const {
  if (hit_ratios_.empty() || sigmas_.empty() || match.matches < mapper_.fallback_matches)
    return true;
  return match.hit_ratio < mapper_.fallback_hit_ratio * upperMedian(hit_ratios_.values()) ||
         !(sigma <= mapper_.fallback_sigma * upperMedian(sigmas_.values()));
}

}  // namespace edgevox
