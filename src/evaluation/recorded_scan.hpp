// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "edgevox/io/trajectory_io.hpp"
#include "edgevox/scan/motion.hpp"
#include "edgevox/scan/voxelizer.hpp"
#include "sim/scanner.hpp"

namespace edgevox {

/// Where the sensor is around the stamp of a scan.
struct SensorMotion {
  Pose T_map_sensor = Pose::Identity();  ///< at the stamp
  Twist before;                          ///< of the sensor, from the pose before to this one
  Twist after;                           ///< from this pose to the next

  /// T_map_sensor `time_offset` s after the stamp.
  Pose poseAt(double time_offset) const {
    return T_map_sensor * moved(time_offset < 0.0 ? before : after, time_offset);
  }
};

/// Of a pose of a trajectory, which is not empty.
SensorMotion motionAt(const Trajectory& trajectory, size_t at);

/// A cloud with its pose. It can be moved, not copied: the view shows its own bytes.
struct RecordedScan : SensorMotion {
  RecordedScan() = default;
  RecordedScan(RecordedScan&&) = default;
  RecordedScan& operator=(RecordedScan&&) = default;

  std::vector<uint8_t> bytes;
  CloudView view;
};

/// A sweep as a cloud of x, y, z and time, without a pose.
RecordedScan recordedScan(const sim::Scan& scan);

/// The stamp, points and times of a scan that recordedScan() has made.
sim::Scan sweepOf(const RecordedScan& recorded);

}  // namespace edgevox
