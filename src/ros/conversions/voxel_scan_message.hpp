// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <edgevox/VoxelScanStamped.h>

#include <optional>
#include <string>
#include <vector>

#include "edgevox/config.hpp"
#include "edgevox/grid/voxel.hpp"
#include "edgevox/scan/voxel_scan.hpp"
#include "ros/conversions/scan_refusal.hpp"

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

/// Why a nodelet with this configuration does not use the message; nothing if it does. The stamp
/// must be one that ROS can carry, and no setting may differ, but for those that change no result.
std::optional<ScanRefusal> refusalOf(const VoxelScanStamped& message, const Config& config);

}  // namespace edgevox
