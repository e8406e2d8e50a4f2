// SPDX-License-Identifier: BSD-3-Clause
#include "run/scan_advice.hpp"

#include <cmath>

namespace edgevox {
namespace {

std::string percent(double ratio) {
  return std::to_string(static_cast<int>(std::lround(100 * ratio))) + " %";
}

std::string whyLost(const ScanResult& result) {
  const std::string fits = percent(result.hit_ratio) + " of the scan fits the map";
  switch (result.refusal) {
    case Refusal::kTooFar:
      return fits +
             ", but farther from the predicted pose than the sensor can have moved "
             "(mapper/max_speed, mapper/max_turn)";
    case Refusal::kBlocked:
      return fits + ", but it would see through walls there: " + percent(result.blocked) +
             " of its lines of sight, " + percent(result.most_blocked) + " may";
    case Refusal::kDisagrees:
      return fits + ", but in one direction next to nothing does";
    case Refusal::kOutOfGrid:
      return "the pose found is out of the grid's range";
    case Refusal::kNotFound:
      return "it was not found in the map; where it fits best, " + percent(result.hit_share) +
             " of its points lie in occupied voxels";
    case Refusal::kCancelled:
      return "the search in the map was ended by a service, a pose or the end of the nodelet";
    default:
      return fits + ", " + percent(result.required_hit_ratio) + " must";
  }
}

}  // namespace

std::string adviceOn(const ScanResult& result, const std::string& way_out) {
  switch (result.status) {
    case ScanStatus::kLost:
      return whyLost(result) + "; the map is as before: go back to a mapped place, or " + way_out;
    case ScanStatus::kAmbiguous:
      return percent(result.hit_ratio) +
             " of the scan fits the map in more than one place; the map is as before: move on to "
             "where the surroundings differ, or " +
             way_out;
    case ScanStatus::kStale:
      if (result.ahead) {
        return "its stamp is later than that of the last scan by more than mapper/clock_leap; the "
               "next one is used if it is as late: if there was a long pause all is well, else see "
               "to the driver's clock";
      }
      return "its stamp or sweep is not later than that of the scan before; if all scans are like "
             "this, the driver's stamps stand still or two drivers publish on one topic";
    case ScanStatus::kTooFew:
      return "it has too few voxels to be matched; is the sensor covered, or min_range too large?";
    case ScanStatus::kTooLarge:
      return "it has more voxels than voxelizer/max_voxels; choose a larger voxel_size or a "
             "smaller "
             "voxelizer/max_range";
    default:
      return "";
  }
}

}  // namespace edgevox
