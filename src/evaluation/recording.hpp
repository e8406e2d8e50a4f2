// SPDX-License-Identifier: BSD-3-Clause
// What the evaluations work on: the scans of a bag or of a simulated world, with their poses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "edgevox/scan/motion.hpp"
#include "edgevox/scan/voxelizer.hpp"
#include "sim/movers.hpp"
#include "sim/scanner.hpp"
#include "sim/sensor.hpp"
#include "sim/trajectory.hpp"
#include "sim/world.hpp"

namespace edgevox {

struct RecordingOptions {
  std::string input;            ///< a bag, or WORLD[+movers]:SENSOR[:SEED] as in "building:32"
  std::string topic;            ///< of a bag; empty: its only one with clouds
  std::filesystem::path poses;  ///< TUM, of a bag's sensor; empty: as Pipeline finds them
  size_t first = 0;             ///< take the scan of this number, counted from 0, ...
  size_t every = 1;             ///< ... and every n-th from there on ...
  size_t most = 100;            ///< ... and so many at most
};

/// A cloud with its pose. It can be moved, not copied: the view shows its own bytes.
struct RecordedScan {
  RecordedScan() = default;
  RecordedScan(RecordedScan&&) = default;
  RecordedScan& operator=(RecordedScan&&) = default;

  std::vector<uint8_t> bytes;
  CloudView view;
  Pose T_map_sensor = Pose::Identity();  ///< at the stamp
  Twist before;                          ///< of the sensor, from the pose before to this one
  Twist after;                           ///< from this pose to the next
};

/// A sweep as a cloud of x, y, z and time, without a pose.
RecordedScan recordedScan(const sim::Scan& scan);

/// What is known of a simulated recording only.
struct SimulatedTruth {
  sim::World world;
  sim::Movers movers;    ///< empty: nothing moves
  sim::Trajectory path;  ///< from stamp 0
  sim::Sensor sensor;
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

/// True if `input` has the form WORLD[+movers]:SENSOR[:SEED] and there is no such file.
bool isSimulated(const std::string& input);

/// Reads or simulates. Throws std::invalid_argument for an input or option that is wrong, BagError,
/// FileError, TrajectoryError.
Recording makeRecording(const RecordingOptions& options);

/// The points of a scan of a simulated recording, each moved by the true pose at its own time,
/// world frame [m].
std::vector<Eigen::Vector3d> pointsInWorld(const Recording& recording, size_t scan);

}  // namespace edgevox
