// SPDX-License-Identifier: BSD-3-Clause
// A world mapped from true poses, and scans of it.
#pragma once

#include <cstdint>
#include <vector>

#include "edgevox/config.hpp"
#include "edgevox/map/map_builder.hpp"
#include "edgevox/scan/voxel_scan.hpp"
#include "sim/world.hpp"

namespace edgevox::test {

Pose poseOf(const Eigen::Vector3d& position, double yaw);

/// A scan at once by a small lidar of 32 beams.
VoxelScan scanFrom(const sim::World& world, const Pose& T_world_sensor, const Config& config,
                   uint32_t seed);

/// The map of scans at these poses, complete as one from a file.
MatchMap mapFrom(const sim::World& world, const std::vector<Pose>& poses, const Config& config);

/// Two rooms of 8 x 6 m that look alike, their middles at (4, 5) and (16, 5), with doors in y = 2
/// at x = 4 and 16 to a hall between x = -3 and 30; the floor at -1.4 m.
sim::World twinRooms();

/// Poses all over the twin rooms.
std::vector<Pose> posesInTwinRooms();

}  // namespace edgevox::test
