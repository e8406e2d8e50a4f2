// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "edgevox/scan/motion.hpp"
#include "edgevox/scan/voxelizer.hpp"
#include "sim/scanner.hpp"

namespace edgevox {

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

/// The stamp, points and times of a scan that recordedScan() has made.
sim::Scan sweepOf(const RecordedScan& recorded);

}  // namespace edgevox
