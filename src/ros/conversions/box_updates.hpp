// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstddef>
#include <cstdint>
#include <map>

#include "edgevox/grid/block_grid.hpp"
#include "ros/conversions/map_messages.hpp"

namespace edgevox {

/// The boxes of a growing set of voxels, a marker for each block of 16 voxels a side, so that only
/// those of blocks that have changed need to be sent. The work is in proportion to these.
class BoxUpdates {
 public:
  /// What turns the markers given so far into those of `voxels`: a copy of the grid of the last
  /// call, some time later. All of them, after one that deletes what there was, at the first call;
  /// all of them, too, when the heights have grown so much that the colours no longer fit.
  visualization_msgs::MarkerArray next(const BitGrid<16>& voxels, double voxel_size,
                                       const std_msgs::Header& header);
  /// The next call is the first.
  void restart();

 private:
  void count(const BitGrid<16>& voxels, size_t slot, bool added);
  bool doColoursFit(const Heights& heights) const;
  static visualization_msgs::Marker markerOf(const BitGrid<16>& voxels, size_t slot,
                                             double voxel_size, const Heights& heights,
                                             const std_msgs::Header& header);

  bool first_ = true;
  BitGrid<16> last_;
  std::map<int32_t, size_t> layers_;  // voxels by z
  Heights coloured_;                  // by which the colours were chosen
};

}  // namespace edgevox
