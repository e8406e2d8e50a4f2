// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include <Eigen/Core>

#include "edgevox/occupied_voxel_map.hpp"

namespace edgevox {

/// Centroids of the voxels of level 0, in the order of the voxels [m].
std::vector<Eigen::Vector3f> centroidsOf(const OccupiedVoxelMap& map, const BitGrid<16>& voxels);

/// Binary files, complete or not there at all. Throw FileError.
void writePly(const std::filesystem::path& file, const std::vector<Eigen::Vector3f>& points);
void writePcd(const std::filesystem::path& file, const std::vector<Eigen::Vector3f>& points);

}  // namespace edgevox
