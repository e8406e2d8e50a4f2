// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/tracking/acceptance.hpp"

#include <algorithm>

namespace edgevox {
namespace {

constexpr double kTrusted = 0.95;  // of the running median of the hit ratios

}  // namespace

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

/// Before there is a history, a match is not trusted.
void Acceptance::setHitRatios(MatchRequest& request) const {
  if (hit_ratios_.empty()) {
    request.required_hit_ratio = matcher_.min_hit_ratio;
    request.far_hit_ratio = matcher_.min_hit_ratio;
    request.trusted_hit_ratio = 1.0;
    return;
  }
  const double usual = hit_ratios_.median();
  request.required_hit_ratio = matcher_.relative_hit_ratio * usual;
  request.trusted_hit_ratio = kTrusted * usual;
  request.far_hit_ratio = request.trusted_hit_ratio;
}

bool Acceptance::needsFallback(const MatchResult& match, double sigma) const {
  return match.matches < mapper_.fallback_matches ||
         (!hit_ratios_.empty() &&
          match.hit_ratio < mapper_.fallback_hit_ratio * hit_ratios_.median()) ||
         (!sigmas_.empty() && sigma > mapper_.fallback_sigma * sigmas_.median());
}

}  // namespace edgevox
