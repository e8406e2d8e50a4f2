// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <string>

#include "edgevox/config.hpp"
#include "edgevox/scan/voxelizer.hpp"

namespace edgevox {

/// How the times of a cloud's points are read.
struct PointTimes {
  TimeField field;   ///< not present: they are not used
  std::string name;  ///< of the field; empty if there is none to be used
  std::string note;  ///< why they are not used, or what is strange about them; else empty
};

/// Finds a field `time`, `t`, `timestamp`, `time_stamp`, `offset_time` or `time_offset` (any case)
/// of type float32, float64 or uint32. Its unit is the one in which a sweep takes up to 2 s, its
/// origin the stamp, the epoch, or, if it is another clock's, the first point of the cloud; both
/// may be told by the configuration. If more than one time in twenty is not within 2 s of the
/// stamp, none is used. `view` is that of the cloud, without times.
PointTimes pointTimesOf(const sensor_msgs::PointCloud2& cloud, const CloudView& view,
                        const VoxelizerConfig& config);

}  // namespace edgevox
