// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "edgevox/grid/voxel.hpp"

namespace edgevox {

struct Segment {
  Eigen::Vector3d start;
  Eigen::Vector3d end;

  double distanceTo(const Eigen::Vector3d& point) const;
};

/// Finds the segments near a point.
class SegmentIndex {
 public:
  /// `reach` [m]: the farthest that is ever asked for.
  SegmentIndex(std::vector<Segment> segments, double reach);

  const std::vector<Segment>& segments() const { return segments_; }

  /// Calls visit(number) for the segments within reach of the point.
  template <typename Visit>
  void forEachNear(const Eigen::Vector3d& point, const Visit& visit) const {
    const auto cell = cells_.find(cellOf(point));
    if (cell == cells_.end()) return;
    for (const uint32_t i : cell->second) {
      if (segments_[i].distanceTo(point) <= reach_) visit(i);
    }
  }

  /// The distance to the nearest segment [m]; infinite if none is within reach.
  double distanceTo(const Eigen::Vector3d& point) const;

 private:
  uint64_t cellOf(const Eigen::Vector3d& point) const {
    return packedIndex(voxelAt(point, inverse_cell_));
  }
  void insert(uint32_t number);

  std::vector<Segment> segments_;
  double reach_;
  double inverse_cell_;
  std::unordered_map<uint64_t, std::vector<uint32_t>> cells_;  // all segments in reach of the cell
};

}  // namespace edgevox
