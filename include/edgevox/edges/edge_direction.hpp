// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "edgevox/grid/block_grid.hpp"
#include "edgevox/grid/voxel.hpp"

namespace edgevox {

/// Along the edge at each of the voxels: the eigenvector of the least eigenvalue of the structure
/// tensor, in which the occupancy changes least. Unit vectors; of the two, the one that points up
/// or, if level, to +y or +x.
std::vector<Eigen::Vector3f> edgeDirections(const BitGrid<16>& occupied,
                                            const std::vector<VoxelIndex>& voxels);

}  // namespace edgevox
