// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/trust_tally.hpp"

#include <algorithm>
#include <cmath>

#include "edgevox/scan/motion.hpp"

namespace edgevox {

size_t TrustCounts::count(ScanStatus status) const {
  const auto found = statuses.find(status);
  return found == statuses.end() ? 0 : found->second;
}

TrustCounts& TrustCounts::operator+=(const TrustCounts& more) {
  right += more.right;
  wrong += more.wrong;
  lost += more.lost;
  unknown += more.unknown;
  for (const auto& [status, count] : more.statuses) statuses[status] += count;
  right_distances.insert(right_distances.end(), more.right_distances.begin(),
                         more.right_distances.end());
  farthest = std::max(farthest, more.farthest);
  return *this;
}

void TrustTally::add(const ScanResult& scan, const std::optional<Pose>& truth) {
  if (!truth) {
    ++counts_.unknown;
    return;
  }
  ++counts_.statuses[scan.status];
  if (scan.located()) {
    addLocated(scan.T_map_sensor, *truth);
  } else {
    ++counts_.lost;
  }
}

void TrustTally::addLocated(const Pose& T_map_sensor, const Pose& truth) {
  if (!T_truth_map_) T_truth_map_ = truth * T_map_sensor.inverse();
  const Pose off = truth.inverse() * *T_truth_map_ * T_map_sensor;
  const double distance = off.translation().norm();
  const double angle = rotationAngle(off) * 180.0 / M_PI;
  counts_.farthest = std::max(counts_.farthest, distance);
  if (distance <= kWrongDistance && angle <= kWrongAngle) {
    ++counts_.right;
    counts_.right_distances.push_back(distance);
  } else {
    ++counts_.wrong;
  }
}

}  // namespace edgevox
