// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <edgevox/VoxelScanStamped.h>

#include <optional>
#include <string>
#include <vector>

#include "edgevox/config.hpp"
#include "edgevox/voxel.hpp"

namespace edgevox {

/// Everything of the scan but its edge count; `header` is the cloud's.
VoxelScanStamped toMessage(const VoxelScan& scan, const std_msgs::Header& header);

/// Whether a voxelizer can have made it: finite, in the grid's range, of some points.
bool isPossible(const Voxel& voxel, double voxel_size);

/// Voxels that no voxelizer makes are left out.
VoxelScan fromMessage(const VoxelScanStamped& message);

/// Adds the parameters whose names begin with one of `prefixes` to the message.
void addSettings(Config config, const std::vector<std::string>& prefixes,
                 VoxelScanStamped& message);

/// The first setting of the message that differs from `config`, in words that say what to do;
/// nothing if there is none. Parameters that change no result are not compared.
std::optional<std::string> mismatchOf(const VoxelScanStamped& message, Config config);

}  // namespace edgevox
