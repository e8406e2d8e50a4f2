// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <optional>
#include <utility>

namespace edgevox {

/// Watches whether stamps go forward. One far in the past or in the future may be wrong; a second
/// one after it shows that the clock has jumped.
class ClockWatch {
 public:
  enum class Order {
    kInTime,
    kLate,
    kAhead,  ///< too far after the last one
    kJumpedBack,
  };

  /// `least_jump` [s]: a stamp less in the past is late. `leap` [s]: one more in the future must be
  /// confirmed.
  ClockWatch(double least_jump, double leap) : least_jump_(least_jump), leap_(leap) {}

  /// Compares with the last accepted stamp [s]; one that is not finite is late.
  Order check(double stamp) {
    if (!std::isfinite(stamp)) return Order::kLate;
    const std::optional<double> suspected = std::exchange(suspected_, std::nullopt);
    if (!last_) return Order::kInTime;
    const std::optional<double> previous = std::exchange(previous_, std::nullopt);
    if (stamp > *last_) {
      previous_ = stamp;
      const bool near = isSoonAfter(*last_, stamp) || (previous && isSoonAfter(*previous, stamp));
      return near ? Order::kInTime : Order::kAhead;
    }
    if (!(stamp < *last_ - least_jump_)) return Order::kLate;
    if (suspected && stamp > *suspected) return Order::kJumpedBack;
    suspected_ = stamp;
    return Order::kLate;
  }

  void accept(double stamp) { last_ = stamp; }
  void reset() { *this = ClockWatch(least_jump_, leap_); }

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.last_, self.previous_, self.suspected_);
  }

 private:
  bool isSoonAfter(double before, double stamp) const {
    return stamp > before && stamp - before <= leap_;
  }

  double least_jump_;
  double leap_;
  std::optional<double> last_;
  std::optional<double> previous_;   // the one before, if it is after the last
  std::optional<double> suspected_;  // of the past
};

}  // namespace edgevox
