// SPDX-License-Identifier: BSD-3-Clause
// Scans by the true motion of the sensor.
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "edgevox/grid/voxel.hpp"
#include "edgevox/scan/voxel_scan.hpp"

namespace edgevox {

/// Where the sensor truly was `time_offset` s after a scan's stamp, in any frame that stands still;
/// empty if that is not known.
using TruePose = std::function<Pose(double time_offset)>;

/// Of a scan whose points are all seen from one place.
TruePose standingAt(const Pose& T_map_sensor);

/// Centroids, each at the pose of its time, in the frame of the truth [m].
std::vector<Eigen::Vector3d> placedCentroids(const VoxelScan& scan, const TruePose& truth);

/// The scan as the sensor would have seen it in the moment of its stamp.
VoxelScan seenAtOnce(VoxelScan scan, const TruePose& truth);

}  // namespace edgevox
