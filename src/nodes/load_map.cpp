// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/load_map.hpp"

#include "edgevox/io/atomic_file.hpp"

namespace edgevox {

MapFile readMapFile(const std::string& file, const TrackingParameters& parameters) {
  if (file.empty() || file.front() != '/') {
    throw FileError("the map file '" + file + "' is not absolute; begin it with /");
  }
  MapFile map = MapFile::read(file);
  map.requireSameMap(parameters.config);
  if (map.head().map_frame != parameters.map_frame) {
    throw ConfigError("the map '" + file + "' is in frame '" + map.head().map_frame +
                      "', not in '" + parameters.map_frame +
                      "': set map_frame to it and start again");
  }
  return map;
}

std::string loadedText(const std::string& file, const MapFile& map) {
  return "loaded " + file + ": " + std::to_string(map.head().occupied_voxels) +
         " occupied voxels, " + std::to_string(map.head().edge_voxels) + " of them on edges, of " +
         std::to_string(map.head().scans) + " scans";
}

ScanRefusal noMap(const std::string& error) {
  return {"no_map", error + "; call load_map with another file"};
}

}  // namespace edgevox
