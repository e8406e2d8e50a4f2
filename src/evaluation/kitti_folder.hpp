// SPDX-License-Identifier: BSD-3-Clause
// Sequences of KITTI's odometry benchmark.
#pragma once

#include <filesystem>
#include <vector>

#include "evaluation/posed_files.hpp"

namespace edgevox {

/// Poses of the velodyne in its first frame, from those of the camera in the file given or
/// poses.txt and from calib.txt. Stamps are those of times.txt, or 0.1 s apart if there is none.
/// Throws FileError.
std::vector<PosedFile> kittiScans(const ScanFolder& folder);

/// Points of x, y, z [m] and reflectance as float32. Throws FileError.
RecordedScan readKitti(const std::filesystem::path& file);

}  // namespace edgevox
