// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/tracking/scan_result.hpp"

namespace edgevox {

const char* toString(ScanStatus status) {
  switch (status) {
    case ScanStatus::kFirst:
      return "first";
    case ScanStatus::kTracked:
      return "tracked";
    case ScanStatus::kFallback:
      return "fallback";
    case ScanStatus::kLost:
      return "lost";
    case ScanStatus::kAmbiguous:
      return "ambiguous";
    case ScanStatus::kStale:
      return "stale";
    case ScanStatus::kTooFew:
      return "too_few";
    case ScanStatus::kTooLarge:
      return "too_large";
  }
  return "";
}

const char* odometryJumpText() {
  return "its odometry has jumped by more than mapper/max_speed, mapper/max_turn and inertia "
         "allow; see to what publishes odom_frame: its poses must be continuous";
}

const char* begunAnewText() {
  return "the map is begun anew with it, as more scans did not fit the map than it was made of; "
         "was the sensor covered at the start?";
}

}  // namespace edgevox
