// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "edgevox/config.hpp"
#include "edgevox/matching/matcher.hpp"

namespace edgevox {

/// Median of the last values.
class RunningMedian {
 public:
  void add(double value);
  bool empty() const { return values_.empty(); }
  double median() const;

 private:
  static constexpr size_t kWindow = 31;
  std::vector<double> values_;
  size_t next_ = 0;
};

/// What a match must reach, by what the last ones did.
class Acceptance {
 public:
  Acceptance(const MatcherConfig& matcher, const MapperConfig& mapper)
      : matcher_(matcher), mapper_(mapper) {}

  /// Sets the hit ratios of a request.
  void setHitRatios(MatchRequest& request) const;
  /// Whether a match to the selected surfaces is too weak; `sigma` as of worstSigma() [m].
  bool needsFallback(const MatchResult& match, double sigma) const;
  void addHitRatio(double ratio) { hit_ratios_.add(ratio); }
  void addSigma(double sigma) { sigmas_.add(sigma); }

 private:
  MatcherConfig matcher_;
  MapperConfig mapper_;
  RunningMedian hit_ratios_;
  RunningMedian sigmas_;
};

}  // namespace edgevox
