// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "edgevox/config.hpp"
#include "edgevox/grid/voxel.hpp"
#include "edgevox/map/match_map.hpp"
#include "edgevox/matching/global_search.hpp"
#include "edgevox/matching/matcher.hpp"
#include "edgevox/scan/voxel_scan.hpp"
#include "edgevox/tracking/acceptance.hpp"
#include "edgevox/tracking/clock_watch.hpp"
#include "edgevox/tracking/motion_model.hpp"
#include "edgevox/tracking/odometry_watch.hpp"
#include "edgevox/tracking/scan_result.hpp"

namespace edgevox {

struct SweepTime;

/// A map to track in, as it is for one scan.
struct TrackedMap {
  const MatchMap& map;
  bool empty = false;    ///< then the scan is put where its prior says
  uint32_t version = 0;  ///< seeds the restarts; differs after each change
  /// Called before all surfaces are matched to, not only the selected ones: brings them up to date.
  std::function<void()> prepareAll = [] {};
};

/// Finds where the sensor is: refuses scans by their stamps and sizes, predicts, deskews, matches,
/// verifies. Only reads the map. A scan that is not located leaves the pose as it was.
class Tracker {
 public:
  explicit Tracker(const Config& config);

  /// What the stamp of the next scan says. To be called first, once a scan; after a jump back of
  /// the clock the motion is forgotten.
  ClockWatch::Order checkStamp(double stamp);
  /// All of the result but its times and `clock_jumped`.
  ScanResult track(const VoxelScan& scan, const ScanPrior& prior, const TrackedMap& tracked);

  /// Looks for the scan without a prediction; by its prior it is known where up is. Changes
  /// nothing: see setPose().
  SearchResult search(const VoxelScan& scan, const ScanPrior& prior, const GlobalSearch& search,
                      const std::optional<SearchRegion::Around>& around,
                      const SearchControl& control) const;

  /// What keeps a scan from being located anywhere: kTooFew, kTooLarge or nothing.
  std::optional<ScanStatus> faultOf(const VoxelScan& scan) const;
  /// The result of a scan that is refused for its stamp.
  ScanResult stale(const VoxelScan& scan, bool ahead) const;
  /// The result of a scan that is not located.
  ScanResult notLocated(const VoxelScan& scan, ScanStatus status) const;

  /// The centroids of the scan that was located last, deskewed, in the map frame [m].
  std::vector<Eigen::Vector3d> placed(const VoxelScan& scan) const;
  /// The sensor in the middle of its sweep [m].
  Eigen::Vector3d sensor() const { return motion_.last().T_map_sensor.translation(); }
  const Pose& T_map_sensor() const { return motion_.T_map_sensor(); }

  /// Infinite if it is not known.
  double secondsSinceLocated(double stamp) const;
  uint64_t lostInARow() const { return lost_in_a_row_; }

  /// The sensor is here, and not lost any more; how it moves is not known.
  void setPose(const Pose& T_map_sensor);
  /// Makes the tracker as new.
  void reset();

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.clock_watch_, self.odometry_watch_, self.motion_, self.acceptance_, self.covariance_,
          self.lost_in_a_row_);
  }

 private:
  /// The next scan is predicted where the last one was.
  void forgetMotion();
  Pose firstPose(const ScanPrior& prior) const;
  void align(const VoxelScan& scan, const SweepTime& sweep, const TrackedMap& tracked,
             SweepPose& now, ScanResult& result);
  MatchResult locate(const ScanSample& sample, const MatchRequest& request,
                     const TrackedMap& tracked, ScanResult& result);
  double fastestChange() const;
  /// Whether a sensor without odometry is predicted to move as before; else it is lost too long.
  bool goesOn() const { return lost_in_a_row_ <= 1; }
  Prediction predict(double time) const;
  MatchRequest requestFor(const SweepPose& now, const Prediction& predicted,
                          uint32_t version) const;

  Config config_;
  ClockWatch clock_watch_;  // of the located scans
  OdometryWatch odometry_watch_;
  Matcher matcher_;
  MotionModel motion_;
  Acceptance acceptance_;
  Matrix6 covariance_ = Matrix6::Zero();  // of the last located pose
  uint64_t lost_in_a_row_ = 0;
};

}  // namespace edgevox
