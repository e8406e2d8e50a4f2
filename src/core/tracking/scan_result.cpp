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
    case ScanStatus::kStale:
      return "stale";
    case ScanStatus::kTooFew:
      return "too_few";
    case ScanStatus::kTooLarge:
      return "too_large";
  }
  return "";
}

}  // namespace edgevox
