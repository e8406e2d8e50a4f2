// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "edgevox/config.hpp"
#include "edgevox/matching/matcher.hpp"
#include "edgevox/ring_buffer.hpp"

namespace edgevox {

/// What a match must reach, by what the last ones did.
class Acceptance {
 public:
  Acceptance(const MatcherConfig& matcher, const MapperConfig& mapper)
      : matcher_(matcher), mapper_(mapper) {}

  /// Sets what a match must reach: more after a scan that was lost; `blind`, where the guess is no
  /// prediction but the pose before, near it as much as far from it, and more with each lost scan.
  /// By how sure the request's guess is, which is set before.
  void setLimits(uint64_t lost_in_a_row, bool blind, MatchRequest& request) const;
  /// Whether a match to the selected surfaces is too weak; `sigma` as of worstSigma() [m].
  bool needsFallback(const MatchResult& match, double sigma) const;
  void addHitRatio(double ratio) { hit_ratios_.push(ratio); }
  void addBlocked(double share) { blocked_.push(share); }
  void addSigma(double sigma) { sigmas_.push(sigma); }

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.hit_ratios_, self.sigmas_, self.blocked_);
  }

 private:
  static constexpr size_t kWindow = 31;

  MatcherConfig matcher_;
  MapperConfig mapper_;
  RingBuffer<double> hit_ratios_{kWindow};
  RingBuffer<double> sigmas_{kWindow};
  RingBuffer<double> blocked_{kWindow};
};

}  // namespace edgevox
