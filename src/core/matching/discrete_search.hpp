// SPDX-License-Identifier: BSD-3-Clause
// The poses at which most points of a scan lie in occupied voxels, looked for in steps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "edgevox/grid/voxel.hpp"
#include "edgevox/map/match_map.hpp"
#include "edgevox/matching/matcher.hpp"

namespace edgevox {

/// Translation in the map's axes, rotation about the sensor.
using Move = Vector6;
Pose apply(const Pose& pose, const Move& move);

/// Counts hits of the first points of a sample. The map and the sample outlive it.
class DiscreteSearch {
 public:
  static constexpr int kFinestLevel = 2;  // of the climb

  DiscreteSearch(const MatchMap& map, const ScanSample& sample, size_t points);

  /// Number of the points that land in occupied voxels of a level; of level 0 in those that the map
  /// holds.
  int hits(int level, const Pose& T_map_sensor);

  /// Climbs from a pose in steps of a voxel and of half of it, at each level from `coarsest` on to
  /// kFinestLevel.
  Pose climb(const Pose& start, int coarsest);
  /// The same, from the coarsest level of the map on.
  Pose climb(const Pose& start) { return climb(start, map_.levels() - 1); }
  /// Climbs as Ryde and Hu 2010: levels coarse to fine to level 0, in steps of a voxel and of a
  /// quarter of a degree * 2^level, moved and turned at once too; a last pass at a quarter of
  /// these.
  Pose climbAsPublished(const Pose& start);

  /// Points looked up in the map up to now.
  uint64_t lookUps() const { return look_ups_; }

 private:
  template <typename Bits>
  int hitsIn(const Bits& occupied, int level, const Pose& T_map_sensor) const;

  const MatchMap& map_;
  const ScanSample& sample_;
  size_t points_;
  uint64_t look_ups_ = 0;
};

/// Where restarts begin.
struct RestartPoses {
  std::vector<Pose> best;  ///< the best first
  int level = 0;           ///< from which to climb, a coarser one
  uint64_t look_ups = 0;
};
/// Of many poses drawn around a guess, the first next to it, the last within 2 m and 50 degrees on
/// each axis, times `reach`, those with most hits in coarse voxels, none near a better one; `most`
/// at most.
RestartPoses restartPoses(const MatchMap& map, const ScanSample& sample, const Pose& guess,
                          double reach, uint64_t seed, size_t most);

}  // namespace edgevox
