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
  std::string time_field;  ///< empty if no times of points are used
  std::string note;        ///< see PointTimes
};

using CloudReading = std::variant<CheckedCloud, CloudError>;

/// A view of a message after a check of its stamp and layout; of the points themselves only some
/// times are looked at: see pointTimesOf().
CloudReading readCloud(const sensor_msgs::PointCloud2& cloud, const VoxelizerConfig& config);

}  // namespace edgevox
