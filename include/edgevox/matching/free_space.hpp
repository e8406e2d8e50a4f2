// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "edgevox/grid/voxel.hpp"
#include "edgevox/map/match_map.hpp"

namespace edgevox {

constexpr size_t kLinesOfSight = 500;  ///< of a scan, looked along to verify its pose

/// The share of the first `count` points, in the sensor's frame [m], whose lines of sight from
/// `T_map_sensor` cross a known plane in an occupied voxel and end well behind it: few where the
/// pose is right, as nobody sees through walls (compare the ray queries of Ryde and Hu 2010).
/// Pose and points in the grid's range.
double blockedShare(const MatchMap& map, const std::vector<Eigen::Vector3d>& points, size_t count,
                    const Pose& T_map_sensor);

}  // namespace edgevox
