// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "edgevox/io/map_file.hpp"
#include "run/report.hpp"
#include "tools/map/map_points.hpp"
#include "tools/map/subcommands.hpp"

namespace edgevox {
namespace {

namespace po = boost::program_options;

po::options_description describe() {
  po::options_description known = withHelp(
      "Usage: map info FILE [--json]\n"
      "Tells what a map file holds. Scans are aligned to planes and surfaces: those of voxels of\n"
      "each size. bytes_in_memory is the size of the map to localize in.\nOptions");
  auto add = known.add_options();
  add("file", po::value<std::string>()->required(), "the map; the first argument");
  add("json", "print JSON");
  return known;
}

Report levelsOf(const MatchMap& map) {
  Report levels;
  for (int l = 0; l < map.levels(); ++l) {
    Report level;
    level.add("voxel_m", map.voxelSize(l));
    level.add("occupied",
              uint64_t{l == 0 ? map.hitVoxels().voxelCount() : map.occupied(l).voxelCount()});
    if (l == 1) level.add("surfaces", uint64_t{map.surfaces().selectedCount()});
    if (l >= MatchMap::kFinestPlanes && l <= MatchMap::kCoarsestPlanes) {
      level.add("planes", uint64_t{map.planes(l).planeCount()});
    }
    levels.add(std::to_string(l), level);
  }
  return levels;
}

/// Of the occupied voxels.
Report extentOf(const MatchMap& map) {
  const std::vector<VoxelIndex> voxels = allVoxels(map.hitVoxels());
  Report extent;
  const auto addAxis = [&](const std::string& name, int32_t VoxelIndex::*axis) {
    const auto [least, greatest] = std::minmax_element(
        voxels.begin(), voxels.end(),
        [&](const VoxelIndex& a, const VoxelIndex& b) { return a.*axis < b.*axis; });
    extent.add(name + "_from", *least.*axis * map.voxelSize(0));
    extent.add(name + "_to", (*greatest.*axis + 1) * map.voxelSize(0));
  };
  if (voxels.empty()) return extent;
  addAxis("x", &VoxelIndex::x);
  addAxis("y", &VoxelIndex::y);
  addAxis("z", &VoxelIndex::z);
  return extent;
}

/// The parameters that are not the defaults.
Report changesOf(Config config) {
  Config defaults;
  const std::vector<Parameter> given = parametersOf(config);
  const std::vector<Parameter> usual = parametersOf(defaults);
  Report changes;
  for (size_t i = 0; i < given.size(); ++i) {
    const std::string value = valueText(given[i]);
    if (value != valueText(usual[i])) changes.add(given[i].name, value);
  }
  return changes;
}

}  // namespace

void mapInfo(const Arguments& arguments) {
  const auto given = parseOptions(arguments, describe(), "file");
  if (!given) return;
  const std::string name = textOf(*given, "file");
  const MapFile file = MapFile::read(name);
  const MatchMap map = file.matchMap();
  Report report;
  report.add("content", std::string(toString(file.head().content)));
  report.add("version", uint64_t{file.version()});
  report.add("frame", file.head().map_frame);
  report.add("scans", file.head().scans);
  report.add("voxel_m", map.voxelSize(0));
  report.add("edges", uint64_t{map.edgeVoxels().voxelCount()});
  report.add("levels", levelsOf(map));
  report.add("extent_m", extentOf(map));
  report.add("bytes", uint64_t{std::filesystem::file_size(name)});
  report.add("bytes_in_memory", uint64_t{map.bytes()});
  report.add("parameters", changesOf(file.config()));
  std::cout << (given->count("json") > 0 ? report.json() : report.table());
}

}  // namespace edgevox
