// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "edgevox/grid/voxel.hpp"
#include "edgevox/matching/matcher.hpp"
#include "edgevox/stage_times.hpp"

namespace edgevox {

enum class ScanStatus {
  kFirst,      ///< the map was empty: the scan fixes the map frame
  kTracked,    ///< aligned to the map's selected voxels
  kFallback,   ///< aligned to all occupied voxels
  kLost,       ///< no match was good enough; the map and the pose are as before
  kAmbiguous,  ///< lost, as matches at distinct poses fit alike
  kStale,      ///< not later than the last located scan, or too much later; not used
  kTooFew,     ///< too few occupied voxels; not used
  kTooLarge,   ///< more points or voxels than allowed; not used
};
const char* toString(ScanStatus status);

/// What became of one scan.
struct ScanResult {
  ScanStatus status = ScanStatus::kLost;
  uint64_t number = 0;
  double stamp = 0.0;                    ///< [s]
  Pose T_map_sensor = Pose::Identity();  ///< at the stamp; the last good one if not located()
  /// Covariance of (translation, rotation vector about the sensor), in the map's axes; m, rad.
  Matrix6 covariance = Matrix6::Zero();
  Degeneracy degeneracy;  ///< what of the pose is only predicted
  double hit_ratio = 0.0;
  double hit_share = 0.0;  ///< of its points in occupied voxels: the rest is new or has changed
  double required_hit_ratio = 0.0;
  double blocked = 0.0;              ///< share of lines of sight that would pass through walls
  double most_blocked = 0.0;         ///< with which it may be located
  Refusal refusal = Refusal::kNone;  ///< why it is lost
  int matches = 0;
  int restarts = 0;
  bool ahead = false;         ///< stale, as later by MapperConfig::clock_leap and not confirmed
  bool clock_jumped = false;  ///< back; the motion was forgotten, and the map if configured so
  /// The odometry of this scan was not used: it has jumped farther than the sensor can have moved.
  bool odometry_jumped = false;
  /// The map was cleared, as more scans did not fit it than it was made of; this is its first.
  bool begun_anew = false;
  StageTimes times;  ///< from `match` on by the mapper, all by the pipeline

  bool located() const {
    return status == ScanStatus::kFirst || status == ScanStatus::kTracked ||
           status == ScanStatus::kFallback;
  }
};

/// What odometry_jumped means and what to do about it.
const char* odometryJumpText();
/// What begun_anew means and what to do about it.
const char* begunAnewText();

/// What is known of a scan besides its voxels.
struct ScanPrior {
  /// The sensor's pose at the stamp in any smooth frame, for the prediction; without it the
  /// velocity is taken as constant, as for a step of it that the sensor cannot have made.
  std::optional<Pose> T_odom_sensor;
  /// Where the sensor is in the map if this is the map's first scan: it fixes the map frame. Of a
  /// place farther from the origin than half the grid's range (100 km at 20 cm) only the rotation
  /// counts: the map's origin is at the sensor then.
  Pose T_map_first = Pose::Identity();
};

}  // namespace edgevox
