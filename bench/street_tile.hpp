// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace edgevox::bench {

/// Voxel centres of the tile-th piece of an endless street: ground, two facades with windows,
/// parked cars; each voxel once [m]. All pieces are alike and touch no other.
std::vector<Eigen::Vector3d> streetTile(int tile, double voxel_size);

/// A place from where the tile is seen [m].
Eigen::Vector3d streetSensor(int tile, double voxel_size);

}  // namespace edgevox::bench
