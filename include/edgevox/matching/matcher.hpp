// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "edgevox/config.hpp"
#include "edgevox/grid/voxel.hpp"
#include "edgevox/map/match_map.hpp"

namespace edgevox {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Centroids of a scan in the sensor's frame [m], in an order in which every prefix is spread
/// over the scan: the search uses the first few of them, the refinement the first that have a
/// voxel of the map beside them.
using ScanSample = std::vector<Eigen::Vector3d>;

/// Where a scan should be, and how surely.
struct Prediction {
  Pose T_map_sensor = Pose::Identity();
  /// On (translation, rotation vector about the sensor), in the map's axes; zero: not known. In
  /// units of MatchResult::information, which takes the points as independent.
  Matrix6 information = Matrix6::Zero();
  /// By an odometry, which decides what the geometry leaves open, and nothing else. A velocity is
  /// less sure: its error would go on for good. It is weighed against what the match says.
  bool measured = false;
  /// Standard deviation of the way since the last located scan [m]; the default: it is not known.
  double step_sigma = 1.0;

  static Prediction withCovariance(const Pose& T_map_sensor, const Matrix6& covariance,
                                   bool measured);

  /// Standard deviation of the translation in the least known direction [m].
  double sigma() const;
};

struct MatchRequest {
  Prediction guess;
  double required_hit_ratio = 0;  ///< restarts are tried until a match reaches it
  double far_hit_ratio = 1.0;     ///< the same for a match farther than the next two
  double far_translation = 2.0;   ///< from the guess [m]
  double far_rotation = 0.7;      ///< the same [rad]
  double most_blocked = 1.0;      ///< share of blocked lines of sight of an accepted match ...
  /// ... unless it is near the guess and has trusted_hit_ratio: glass and doors let lines pass
  double most_blocked_near = 1.0;
  double trusted_hit_ratio = 0;  ///< a refinement that reaches it from the guess needs no search
  bool doubtful = false;         ///< the guess is unsure, see isDoubtful()
  double reach = 1.0;            ///< widening of the restarts; 1 is 1 m and 25 degrees
  double max_translation = 4.0;  ///< of an accepted match from the guess [m]
  double max_rotation = 1.4;     ///< the same [rad]
  bool all_voxels = false;       ///< refine against all occupied voxels
  uint64_t seed = 0;             ///< of the restarts
};

/// Why a match is not accepted.
enum class Refusal {
  kNone,
  kOutOfGrid,  ///< the pose has left the range of the grid
  kTooFar,     ///< from the guess
  kFewHits,    ///< too few points lie in occupied voxels
  kDisagrees,  ///< next to nothing that tells a direction of the pose fits: see agreement
  kBlocked,    ///< too many lines of sight would pass through walls
  kAmbiguous,  ///< another pose, not near it, fits as well
  kNotFound,   ///< a search of the map has found no pose
  kCancelled,  ///< a search was ended from outside
};

/// What the geometry around leaves open, as the way along a bare corridor.
struct Degeneracy {
  int directions = 0;  ///< in which the match says next to nothing
  /// The direction that the match says least of: a unit vector of (translation, rotation vector
  /// times the median range of the scan), in the map's axes.
  Vector6 weakest = Vector6::Zero();
};

struct MatchResult {
  Pose T_map_sensor = Pose::Identity();
  double hit_ratio = 0.0;           ///< see Hits
  double hit_share = 0.0;           ///< the same
  double blocked = 0.0;             ///< see blockedShare()
  double required_hit_ratio = 0.0;  ///< as far from the guess as it is
  double most_blocked = 1.0;        ///< the same
  Refusal refusal = Refusal::kOutOfGrid;
  int matches = 0;   ///< points with a Gaussian in the last refinement step
  double fit = 0.0;  ///< mean robust weight of the refined points, 0 where there is no match
  /// The share that fits of what the matched points say, in the direction of the pose in which it
  /// is least; 1 where they say nothing, or nobody has asked.
  double agreement = 1.0;
  int restarts = 0;
  uint64_t look_ups = 0;  ///< points looked up in the map: the work of all of it
  /// Information of the last step, on (translation, rotation vector about the sensor), in the map's
  /// axes; none in degenerate directions.
  Matrix6 information = Matrix6::Zero();
  /// The same as a covariance, with what a prediction adds; finite [m, rad].
  Matrix6 covariance = Matrix6::Zero();
  Degeneracy degeneracy;

  bool accepted() const { return refusal == Refusal::kNone; }
};

/// Whether a match from an unsure guess may be one of several answers.
inline bool isDoubtful(const MatchRequest& request, const MatchResult& match) {
  return request.doubtful && match.hit_ratio < request.trusted_hit_ratio;
}

/// The share of a scan's points that lie in occupied voxels.
struct Hits {
  double share = 0.0;  ///< of all: the rest is new or has changed
  /// Of those in occupied voxels eight times the finest, as points of a place not mapped yet tell
  /// nothing; if these are less than a quarter of all, it is that of the quarter.
  double ratio = 0.0;
};

/// Aligns a scan to an occupied voxel map: discrete search from coarse to fine (Ryde and Hu
/// 2010), then robust Gauss-Newton from points to voxel Gaussians; verified by the hit ratio.
/// Deterministic: integer scores, fixed tie-breaks, sums in a fixed order.
class Matcher {
 public:
  explicit Matcher(const MatcherConfig& config) : config_(config) {}

  /// How many points a sample should have, and how many of them are verified and, at most, refined.
  size_t sampleSize() const;
  size_t refinePoints(const ScanSample& sample) const;

  /// The match from the guess; where it is not accepted, or not beyond doubt, the best of it and of
  /// restarts around it, which is ambiguous if another one fits as well.
  MatchResult match(const MatchMap& map, const ScanSample& sample,
                    const MatchRequest& request) const;
  /// The match from the guess alone.
  MatchResult align(const MatchMap& map, const ScanSample& sample,
                    const MatchRequest& request) const;

  struct Refinement {
    Pose start = Pose::Identity();
    Prediction predicted;
    double widening = 1.0;    ///< of the robust kernel's square at first; it narrows to 1
    int steps = 15;           ///< at most
    bool all_voxels = false;  ///< match all surfaces, not only the selected ones
    bool compares = false;    ///< tells MatchResult::agreement
  };
  /// The refinement alone. Whether it is accepted is not asked. It ends where the pose leaves the
  /// grid's range.
  MatchResult refine(const MatchMap& map, const ScanSample& sample,
                     const Refinement& refinement) const;
  /// What of the first `points` of a sample is in occupied voxels of level 1.
  static Hits hits(const MatchMap& map, const ScanSample& sample, size_t points,
                   const Pose& T_map_sensor);

 private:
  MatchResult refineFrom(const MatchMap& map, const ScanSample& sample, const MatchRequest& request,
                         const Pose& start, double widening) const;
  MatchResult verified(const MatchMap& map, const ScanSample& sample, const MatchRequest& request,
                       MatchResult result) const;
  void restart(const MatchMap& map, const ScanSample& sample, const MatchRequest& request,
               MatchResult& best) const;

  MatcherConfig config_;
};

/// Median distance of the first `count` > 0 points from the sensor [m].
double medianRange(const ScanSample& sample, size_t count);

/// Worst standard deviation of a match [m]: of the translation, or of the rotation at `range`.
double worstSigma(const Matrix6& information, double range);

}  // namespace edgevox
