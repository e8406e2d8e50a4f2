// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversions/stamp.hpp"

#include <limits>

namespace edgevox {
namespace {

constexpr uint32_t kSecond = 1000000000;  // [ns]
constexpr uint32_t kYear = 366 * 24 * 3600;
constexpr uint32_t kLatest = std::numeric_limits<uint32_t>::max() - kYear;  // [s]

}  // namespace

std::optional<std::string> faultOf(const ros::Time& stamp) {
  const std::string text =
      "its stamp is " + std::to_string(stamp.sec) + " s and " + std::to_string(stamp.nsec) + " ns";
  if (stamp.isZero()) return text + ", as if never set";
  if (stamp.nsec >= kSecond) return text + ", more than a second of nanoseconds";
  if (stamp.sec >= kLatest) return text + ", too late for ROS to calculate with";
  return std::nullopt;
}

}  // namespace edgevox
