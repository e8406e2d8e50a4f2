// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "evaluation/scan_stream.hpp"

namespace edgevox {

/// Of a folder with scans of one of these formats:
/// - 3DTK: scanNNN.3d and scanNNN.pose;
/// - KITTI odometry: velodyne/NNNNNN.bin or NNNNNN.bin, calib.txt and, if there is one, times.txt;
///   `poses` are the camera's, by default poses.txt;
/// - *.pcd or *.ply; `poses` are the sensor's, TUM format, by default the only *.tum or *.txt.
/// The points have no times, not even where a file has some. Poses are read here, the scans by the
/// stream. Throws std::invalid_argument, FileError, TrajectoryError, and so does the stream.
ScanStream folderStream(const std::filesystem::path& folder, const std::filesystem::path& poses);

}  // namespace edgevox
