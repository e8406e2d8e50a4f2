// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ctime>

namespace edgevox {

enum class Clock { kWall, kProcessCpu };

/// Time between calls of lap().
class StageTimer {
 public:
  explicit StageTimer(Clock clock)
      : id_(clock == Clock::kWall ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID), last_(now()) {}

  /// Seconds since construction or the last call.
  double lap() {
    const double t = now();
    const double elapsed = t - last_;
    last_ = t;
    return elapsed;
  }

 private:
  double now() const {
    timespec t{};
    clock_gettime(id_, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }

  clockid_t id_;
  double last_;
};

}  // namespace edgevox
