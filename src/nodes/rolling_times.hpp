// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "edgevox/statistics.hpp"

namespace edgevox {

/// The last hundred durations.
class RollingTimes {
 public:
  void add(double seconds) {
    if (seconds_.size() < kWindow) {
      seconds_.push_back(seconds);
    } else {
      seconds_[next_] = seconds;
    }
    next_ = (next_ + 1) % kWindow;
  }

  /// [s]; NaN if there are none
  double quantile(double q) const { return edgevox::quantile(seconds_, q); }

 private:
  static constexpr size_t kWindow = 100;

  std::vector<double> seconds_;
  size_t next_ = 0;
};

}  // namespace edgevox
