// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <string>
#include <variant>

#include "edgevox/scan/voxelizer.hpp"

namespace edgevox {

/// Why a cloud cannot be read.
enum class CloudFault {
  kStamp,
  kEmpty,
  kBigEndian,
  kMissingCoordinate,
  kDuplicateCoordinate,
  kCoordinateType,
  kPointStep,
  kRowStep,
  kDataSize,
  kTooLarge,  ///< by the voxelizer
};
const char* toString(CloudFault fault);

struct CloudError {
  CloudFault fault;
  std::string text;  ///< what is wrong, where, and what to do
};

struct CheckedCloud {
  CloudView view;          ///< valid as long as the message
  std::string time_field;  ///< empty if the points have no times
  std::string note;        ///< a time field that is not understood; else empty
};

using CloudReading = std::variant<CheckedCloud, CloudError>;

/// A view of a message after a check of its stamp and layout; the points themselves are not looked
/// at. The time of a point is read from a field `time`, `t`, `timestamp`, `time_stamp`,
/// `offset_time` or `time_offset` (any case): float32 in seconds and uint32 in nanoseconds count
/// from the cloud's stamp; float64 is the time since the epoch in seconds or nanoseconds, or, if it
/// is small, seconds from the stamp.
CloudReading readCloud(const sensor_msgs::PointCloud2& cloud);

}  // namespace edgevox
