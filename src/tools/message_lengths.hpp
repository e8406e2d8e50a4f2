// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace edgevox {

/// Whether the lengths within a serialized message add up to its size. To be asked before it is
/// decoded, which takes memory for any length that it finds.
bool isCloudOfSize(const uint8_t* bytes, size_t size);       ///< sensor_msgs/PointCloud2
bool isTransformsOfSize(const uint8_t* bytes, size_t size);  ///< tf2_msgs/TFMessage

}  // namespace edgevox
