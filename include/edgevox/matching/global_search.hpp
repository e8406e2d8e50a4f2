// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "edgevox/config.hpp"
#include "edgevox/grid/voxel.hpp"
#include "edgevox/map/match_map.hpp"
#include "edgevox/matching/matcher.hpp"

namespace edgevox {

class ShiftPyramid;

/// The poses among which a scan is looked for.
struct SearchRegion {
  /// Turns the sensor's axes into such whose z axis points up as the map's does.
  Eigen::Matrix3d R_level_sensor = Eigen::Matrix3d::Identity();
  double tilt = 0.0;  ///< by which that may be off [rad]; pi: nothing is known

  struct Around {
    Pose T_map_sensor = Pose::Identity();  ///< tells where up is, too
    double distance = 0.0;                 ///< along each axis of the map [m]
    double turn = 0.0;                     ///< about its z axis [rad]
  };
  std::optional<Around> around;  ///< none: everywhere in the map

  /// About a pose that somebody has pointed to: 3 m and 60 degrees.
  static Around near(const Pose& T_map_sensor);
};

/// A pose at which many points of a scan lie in occupied voxels.
struct Candidate {
  Pose T_map_sensor = Pose::Identity();
  int hits = 0;
};

enum class SearchOutcome {
  kFound,      ///< one pose fits, and no other as well
  kAmbiguous,  ///< several poses fit alike
  kNotFound,   ///< no pose fits
  kCancelled,
};
const char* toString(SearchOutcome outcome);

/// How much speaks for a match, whether known before or not: the share of all points that lie in
/// occupied voxels, less half of that of the lines of sight that would pass through walls, as some
/// of the walls are none.
template <typename Match>
double evidenceOf(const Match& match) {
  return match.hit_share * (1.0 - 0.5 * match.blocked);
}

/// The least evidence of a pose that cannot be told from the best one.
double leastAlike(double best, const SearchConfig& config);

struct SearchResult {
  SearchOutcome outcome = SearchOutcome::kNotFound;
  /// Distinct poses, refined, by evidence: the best first, then the runner-up. All of a search that
  /// is ambiguous fit alike.
  std::vector<MatchResult> answers;
};

constexpr int kAllProcessors = 1024;

/// Of a search that is going on, for other threads.
struct SearchControl {
  int threads = 1;                            ///< what is found does not depend on it
  const std::atomic<bool>* cancel = nullptr;  ///< ends the search when it becomes true
  std::atomic<int>* percent = nullptr;        ///< how far it is

  bool isCancelled() const { return cancel != nullptr && *cancel; }
};

/// Finds where in a map a scan was taken, without a prediction: branch and bound over all
/// translations at each rotation of a grid (compare Olson 2015, Hess et al. 2016); the best poses
/// are refined and verified.
class GlobalSearch {
 public:
  explicit GlobalSearch(const MatchMap& map, const Config& config);
  GlobalSearch(GlobalSearch&&) noexcept;
  GlobalSearch& operator=(GlobalSearch&&) noexcept;
  ~GlobalSearch();

  /// The poses that fit the scan; its points as for Matcher.
  SearchResult search(const ScanSample& sample, const SearchRegion& region,
                      const SearchControl& control = {}) const;

  /// All poses of the grid with at least `share` of the hits of the best one, and at least `least`
  /// hits, but none near a better one; by hits, `most` at most. No pose of the grid is overlooked.
  std::vector<Candidate> candidates(const ScanSample& sample, const SearchRegion& region,
                                    double share, int least, size_t most,
                                    const SearchControl& control = {}) const;

  /// Size of what is held beside the map.
  size_t bytes() const;

 private:
  MatchMap map_;
  Matcher matcher_;
  SearchConfig config_;
  double cell_ = 0.0;  // [m]
  std::unique_ptr<ShiftPyramid> pyramid_;
};

}  // namespace edgevox
