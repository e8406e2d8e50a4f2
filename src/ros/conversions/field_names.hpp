// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sensor_msgs/PointField.h>

#include <array>
#include <cstdint>
#include <string>

namespace edgevox {

/// Of a PointField's type, as in "float32".
inline std::string typeName(uint8_t datatype) {
  constexpr std::array<const char*, 9> kNames = {"none",  "int8",   "uint8",   "int16",  "uint16",
                                                 "int32", "uint32", "float32", "float64"};
  return datatype < kNames.size() ? kNames[datatype] : "unknown type " + std::to_string(datatype);
}

}  // namespace edgevox
