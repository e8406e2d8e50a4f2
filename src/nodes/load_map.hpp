// SPDX-License-Identifier: BSD-3-Clause
// What the services of maps have in common.
#pragma once

#include <ros/console.h>

#include <cstdint>
#include <exception>
#include <string>

#include "edgevox/io/map_file.hpp"
#include "ros/conversions/scan_refusal.hpp"
#include "ros/live/parameters.hpp"
#include "ros/live/throttled_log.hpp"

namespace edgevox {

/// A map of the frame and with the map's parameters of a node. Throws FileError, MapFileError and
/// ConfigError.
MapFile readMapFile(const std::string& file, const TrackingParameters& parameters);

std::string loadedText(const std::string& file, const MapFile& map);

/// Of a scan for which there is no map, as told by `error`.
ScanRefusal noMap(const std::string& error);

/// Does what is asked for and answers with its text or, if it throws, with why not.
template <typename Response, typename Task>
bool answer(Response& response, ThrottledLog& log, const Task& task) {
  try {
    response.message = task();
    response.success = static_cast<uint8_t>(true);
    ROS_INFO_STREAM(response.message);
  } catch (const std::exception& error) {
    response.message = error.what();
    response.success = static_cast<uint8_t>(false);
    log.warn("service", response.message);
  }
  return true;
}

}  // namespace edgevox
