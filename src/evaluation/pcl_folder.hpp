// SPDX-License-Identifier: BSD-3-Clause
// Folders of PCD or PLY files with a trajectory.
#pragma once

#include <filesystem>
#include <vector>

#include "evaluation/posed_files.hpp"

namespace edgevox {

/// The trajectory, TUM format, is that given or the only one in the folder. If it has a pose for
/// each scan, these belong together in their order; else a scan's name is its stamp [s], and its
/// pose is that of poseAround(). Throws std::invalid_argument, FileError, TrajectoryError.
std::vector<PosedFile> pclScans(const ScanFolder& folder);

/// The fields x, y and z, metres; all else is left out, also the viewpoint. Throw FileError.
RecordedScan readPcd(const std::filesystem::path& file);
RecordedScan readPly(const std::filesystem::path& file);

}  // namespace edgevox
