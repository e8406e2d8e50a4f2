// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "edgevox/ring_buffer.hpp"
#include "edgevox/statistics.hpp"

namespace edgevox {

/// The last hundred durations.
class RollingTimes {
 public:
  void add(double seconds) { seconds_.push(seconds); }

  bool empty() const { return seconds_.empty(); }
  /// The quantile of the durations [s]; NaN if there are none.
  double quantile(double q) const { return edgevox::quantile(seconds_.values(), q); }

 private:
  static constexpr size_t kWindow = 100;

  RingBuffer<double> seconds_{kWindow};
};

}  // namespace edgevox
