// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "edgevox/config.hpp"
#include "ros/conversions/sensor_frames.hpp"
#include "tools/options.hpp"

namespace edgevox {

/// Clouds first to last of a bag, both included, counted from 0.
struct CloudRange {
  size_t first = 0;
  size_t last = 0;
};

struct MapBagOptions {
  std::string bag;
  std::filesystem::path output;       ///< a folder
  std::string topic;                  ///< empty: the only one with clouds
  std::string config;                 ///< a preset or a YAML file; empty: the defaults
  std::vector<std::string> settings;  ///< "name=value", applied after the file
  std::string reference;              ///< a TUM file; empty: none
  FrameNames frames;
  size_t stride = 1;  ///< use every stride-th cloud
  std::vector<CloudRange> skipped;
  std::string map;       ///< a full map file to go on with; empty: none
  std::string localize;  ///< a map file to locate the clouds in; empty: none
  /// Where the first cloud is looked for: the sensor in the map; none: everywhere.
  std::optional<Pose> start;
  bool full = false;  ///< save a full map file, not a compact one
  bool write_occupied = false;
};

/// The options of a command line; nothing if only the help was asked for, which is printed. Throws
/// UsageError.
std::optional<MapBagOptions> parseMapBagOptions(const Arguments& arguments);

/// The configuration in force: the defaults, then the file, then the settings. Throws ConfigError.
Config configOf(const MapBagOptions& options, const Config& defaults = {});

bool isUsed(size_t cloud, const MapBagOptions& options);

}  // namespace edgevox
