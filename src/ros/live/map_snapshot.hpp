// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/time.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "edgevox/grid/block_grid.hpp"
#include "edgevox/map/map_builder.hpp"
#include "edgevox/map/match_map.hpp"

namespace edgevox {

/// What is drawn of a map, as it was between two scans.
struct MapSnapshot {
  using Points = std::vector<Eigen::Vector3f>;

  double voxel_size = 0.0;  ///< of level 0 [m]
  BitGrid<16> edge_voxels;
  std::function<Points()> edge_centroids;   ///< in the map frame [m]
  std::function<Points()> occupied_points;  ///< centroids where they are known, else centres [m]
  uint64_t version = 0;                     ///< differs whenever the map does
  uint64_t start = 0;                       ///< differs after a new start of the map or the clock
  ros::Time stamp;                          ///< of the last located scan
};

/// Of a map that is being built, which is copied.
MapSnapshot snapshotOf(const MapBuilder& map);
/// Of a complete map that stays as it is.
MapSnapshot snapshotOf(std::shared_ptr<const MatchMap> map);

}  // namespace edgevox
