// SPDX-License-Identifier: BSD-3-Clause
// What the evaluations work on: the scans of a bag, of a folder or of a simulated world, with their
// poses.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/recorded_scan.hpp"
#include "evaluation/simulated_truth.hpp"

namespace edgevox {

struct RecordingOptions {
  /// A bag, a folder, see folderStream(), or WORLD[+movers]:SENSOR[:SEED] as in "building:32".
  std::string input;
  std::string topic;            ///< of a bag; empty: its only one with clouds
  std::filesystem::path poses;  ///< TUM, of a bag's sensor, or as folderStream() takes them; empty:
                                ///< of a bag as Pipeline finds them
  size_t first = 0;             ///< take the scan of this number, counted from 0, ...
  size_t every = 1;             ///< ... and every n-th from there on ...
  size_t most = 100;            ///< ... and so many at most
};

struct Recording {
  std::string name;    ///< to print
  std::string source;  ///< of the poses, to print
  std::vector<RecordedScan> scans;
  size_t without_pose = 0;              ///< scans left out, as their pose is not known
  std::optional<SimulatedTruth> truth;  ///< the map frame is then the world's

  /// T_map_sensor `time_offset` s after the stamp of a scan.
  Pose poseAt(size_t scan, double time_offset) const;
};

/// When the last ray of a scan of a simulated recording was sent, from the trajectory's start [s].
double endOf(const Recording& recording, size_t scan);

/// Whether a scan is one of those to take, `taken` of which were before it.
bool isWanted(size_t scan, size_t taken, const RecordingOptions& options);

/// How many scans are gone through to have those wanted.
size_t scansToSee(const RecordingOptions& options);

/// Reads or simulates. Throws std::invalid_argument for an input or option that is wrong, BagError,
/// FileError, TrajectoryError.
Recording makeRecording(const RecordingOptions& options);

/// The points of a scan of a simulated recording, each moved by the true pose at its own time,
/// world frame [m].
std::vector<Eigen::Vector3d> pointsInWorld(const Recording& recording, size_t scan);

}  // namespace edgevox
