// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "edgevox/io/trajectory_io.hpp"
#include "edgevox/scan/voxelizer.hpp"
#include "evaluation/placed_scan.hpp"

namespace edgevox {

/// `truth` in any frame that stands still, valid while visit runs; empty if it is not known.
using VisitScan = std::function<void(const CloudView& cloud, const TruePose& truth)>;

/// Goes through the first `most` scans of a recording, of which one at a time is in memory. Safe to
/// call from several threads.
using ScanStream = std::function<void(size_t most, const VisitScan& visit)>;

/// The pose of the trajectory whose stamp is nearest, within 5 ms, with the motion to those beside
/// it; empty if there is none.
TruePose poseAround(double stamp, const Trajectory& trajectory);

/// Of an input of the form WORLD[+movers]:SENSOR[:SEED]. Throws std::invalid_argument.
ScanStream simulatedStream(const std::string& input);

/// Of a bag and its sensor's trajectory, TUM format; without one, of the poses that the default
/// configuration finds from all clouds. Throws BagError, FileError, TrajectoryError, and so does
/// the stream.
ScanStream bagStream(const std::string& bag, const std::filesystem::path& poses,
                     const std::string& topic = "");

/// What a bag or a folder is called, without the folders above it.
std::string recordingName(const std::filesystem::path& recording);

/// Of any input: a simulated world, a folder, see folderStream(), or a bag. Throws what these
/// throw, and std::invalid_argument for poses of a simulated world, whose poses are known.
ScanStream streamOf(const std::string& input, const std::filesystem::path& poses,
                    const std::string& topic = "");

}  // namespace edgevox
