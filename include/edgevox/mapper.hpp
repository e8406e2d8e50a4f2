// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "edgevox/clock_watch.hpp"
#include "edgevox/config.hpp"
#include "edgevox/map_builder.hpp"
#include "edgevox/matcher.hpp"
#include "edgevox/motion.hpp"
#include "edgevox/recent_edges.hpp"
#include "edgevox/stage_timer.hpp"
#include "edgevox/voxel.hpp"

namespace edgevox {

enum class ScanStatus {
  kFirst,     ///< the map was empty: the scan fixes the map frame
  kTracked,   ///< aligned to the map's selected voxels
  kFallback,  ///< aligned to all occupied voxels
  kLost,      ///< no match was good enough; the map and the pose are as before
  kStale,     ///< not later than the last located scan, or too much later; not used
  kTooFew,    ///< too few occupied voxels; not used
  kTooLarge,  ///< more points or voxels than allowed; not used
};
const char* name(ScanStatus status);

struct MapperTimes {
  double match = 0.0;   ///< sampling, prediction, search and refinement [s]
  double insert = 0.0;  ///< [s]
  double label = 0.0;   ///< [s]
};

/// What became of one scan.
struct ScanResult {
  ScanStatus status = ScanStatus::kLost;
  uint64_t number = 0;
  double stamp = 0.0;                    ///< [s]
  Pose T_map_sensor = Pose::Identity();  ///< at the stamp; the last good one if not located()
  /// Of (translation, rotation vector about the sensor), in the map's axes; m, rad.
  Matrix6 covariance = Matrix6::Zero();
  double hit_ratio = 0.0;
  double required_hit_ratio = 0.0;
  int matches = 0;
  int restarts = 0;
  bool ahead = false;         ///< stale, as later by MapperConfig::clock_leap and not confirmed
  bool clock_jumped = false;  ///< back; the motion was forgotten, and the map if configured so
  MapperTimes times;

  bool located() const {
    return status == ScanStatus::kFirst || status == ScanStatus::kTracked ||
           status == ScanStatus::kFallback;
  }
};

/// What is known of a scan besides its voxels.
struct ScanPrior {
  /// At the stamp, in any smooth frame, for the prediction; without it the velocity is taken as
  /// constant.
  std::optional<Pose> T_odom_sensor;
  /// Where the sensor is in the map if this is the map's first scan: it fixes the map frame. Of a
  /// place farther from the origin than half the grid's range (100 km at 20 cm) only the rotation
  /// counts: the map's origin is at the sensor then.
  Pose T_map_first = Pose::Identity();
};

/// Median of the last values.
class RunningMedian {
 public:
  void add(double value);
  bool empty() const { return values_.empty(); }
  double median() const;

 private:
  static constexpr size_t kWindow = 31;
  std::vector<double> values_;
  size_t next_ = 0;
};

struct SweepTime;

/// Builds a map from scans in order of time: predicts, deskews, matches, verifies, inserts. A
/// scan that cannot be matched changes neither the map nor the pose.
class Mapper {
 public:
  explicit Mapper(const Config& config, Clock clock = Clock::kProcessCpu);

  ScanResult process(const VoxelScan& scan, const ScanPrior& prior = {});

  const MapBuilder& map() const { return map_; }
  /// Of the last located scan.
  const RecentEdges& recentEdges() const { return recent_edges_; }
  /// Brings the labels up to date, for output.
  void finishLabels() { map_.label(); }
  /// Forgets map and motion; the next scan is the first.
  void reset();

 private:
  /// The sensor in the middle of a sweep.
  struct Located {
    double time;  // [s]
    Pose T_map_sensor;
    std::optional<Pose> T_odom_sensor;
  };

  Pose firstPose(const ScanPrior& prior) const;
  void forgetMotion();
  void align(const VoxelScan& scan, const SweepTime& sweep, Located& now, ScanResult& result);
  void advance(const VoxelScan& scan, const Located& now);
  Pose predict(const Located& now) const;
  Twist twistTo(double time, const Pose& T_map_sensor) const;
  Twist twistInSweep(const Twist& twist) const;
  MatchResult locate(const ScanSample& sample, const Pose& guess, double time, ScanResult& result);
  bool needsFallback(const MatchResult& match, double sigma) const;
  double requiredHitRatio() const;
  double trustedHitRatio() const;
  void insert(const VoxelScan& scan, const SweepTime& sweep, ScanResult& result);

  Config config_;
  Clock clock_;
  ClockWatch clock_watch_;  // of the located scans
  Matcher matcher_;
  MapBuilder map_;
  RecentEdges recent_edges_;
  Pose T_map_sensor_ = Pose::Identity();  // at the stamp of the last located scan
  std::optional<Located> last_;           // none if the motion is not known
  Twist twist_;                           // from the last but one located sweep to the last
  Twist twist_in_sweep_;                  // in the last one
  uint64_t lost_in_a_row_ = 0;
  RunningMedian hit_ratios_;
  RunningMedian sigmas_;
};

}  // namespace edgevox
