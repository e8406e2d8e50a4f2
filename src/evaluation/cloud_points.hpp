// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "edgevox/scan/voxelizer.hpp"

namespace edgevox {

/// The points that the voxelizer would use, sensor frame [m].
std::vector<Eigen::Vector3f> pointsOf(const CloudView& cloud, const VoxelizerConfig& config);

}  // namespace edgevox
