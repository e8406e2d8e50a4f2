// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "edgevox/grid/voxel.hpp"
#include "edgevox/tracking/scan_result.hpp"

namespace edgevox {

constexpr double kWrongDistance = 0.5;  ///< of a pose that is wrong from the truth [m]
constexpr double kWrongAngle = 5.0;     ///< the same [degrees]

/// What became of scans. A located one is right or wrong; one without a pose is lost, whatever the
/// reason.
struct TrustCounts {
  size_t right = 0;
  size_t wrong = 0;
  size_t lost = 0;
  size_t unknown = 0;                     ///< scans whose true pose is not known; not in the others
  std::map<ScanStatus, size_t> statuses;  ///< of the scans that are right, wrong or lost
  std::vector<double> right_distances;    ///< of the right ones from the truth [m]
  double farthest = 0.0;                  ///< of all located ones from the truth [m]

  size_t located() const { return right + wrong; }
  size_t scans() const { return located() + lost; }
  size_t count(ScanStatus status) const;
  TrustCounts& operator+=(const TrustCounts& more);
};

/// Compares the scans of one run with the truth, in whose frame the first pose is put to the first
/// true one.
class TrustTally {
 public:
  void add(const ScanResult& scan, const std::optional<Pose>& truth);
  const TrustCounts& counts() const { return counts_; }

 private:
  void addLocated(const Pose& T_map_sensor, const Pose& truth);

  std::optional<Pose> T_truth_map_;
  TrustCounts counts_;
};

}  // namespace edgevox
