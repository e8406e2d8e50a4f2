// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "edgevox/grid/voxel.hpp"

namespace edgevox {

/// The occupied leaves that pcl::octree has for these points, by their keys.
std::vector<VoxelIndex> octreeLeaves(const std::vector<Eigen::Vector3f>& points, double leaf_size);

/// The centres of the same [m].
std::vector<Eigen::Vector3f> octreeLeafCentres(const std::vector<Eigen::Vector3f>& points,
                                               double leaf_size);

/// How many leaves remain when eight occupied ones of one parent become one, at all levels. The
/// keys are not negative.
size_t mergedLeafCount(std::vector<VoxelIndex> leaves);

}  // namespace edgevox
