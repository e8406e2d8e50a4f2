// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <utility>

namespace edgevox {

/// Whether stamps go forward. One far in the past may be wrong; a second one after it shows that
/// the clock has jumped back.
class ClockWatch {
 public:
  enum class Order { kInTime, kLate, kJumpedBack };

  /// `least_jump` [s]: a stamp less in the past is late.
  explicit ClockWatch(double least_jump) : least_jump_(least_jump) {}

  /// Compares with the last accepted stamp [s].
  Order check(double stamp) {
    const std::optional<double> suspected = std::exchange(suspected_, std::nullopt);
    if (!last_ || stamp > *last_) return Order::kInTime;
    if (!(stamp < *last_ - least_jump_)) return Order::kLate;
    if (suspected && stamp > *suspected) return Order::kJumpedBack;
    suspected_ = stamp;
    return Order::kLate;
  }

  void accept(double stamp) { last_ = stamp; }
  void reset() { last_.reset(); }

 private:
  double least_jump_;
  std::optional<double> last_;
  std::optional<double> suspected_;
};

}  // namespace edgevox
