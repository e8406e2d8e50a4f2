// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "edgevox/io/atomic_file.hpp"
#include "edgevox/io/map_file.hpp"
#include "run/map_files.hpp"
#include "tools/map/floor_plan.hpp"
#include "tools/map/map_points.hpp"
#include "tools/map/octomap_file.hpp"
#include "tools/map/subcommands.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;

po::options_description describe() {
  po::options_description known = withHelp(
      "Usage: map convert FILE OUTPUT [options]\n"
      "Writes a map as the ending of OUTPUT tells:\n"
      "  .edgevox     a compact map\n"
      "  .ply, .pcd   the centroids of its edges with the direction along the edge as normal, or\n"
      "               with --occupied the centres of all its occupied voxels\n"
      "  .bt          its occupied voxels for OctoMap; free space is not known to the map, so "
      "that\n"
      "               all else is unknown there\n"
      "  .pgm, .yaml  both files of a map for map_server, seen from above: occupied where there "
      "is\n"
      "               something between --from and --to, free where there is only something below\n"
      "               (a floor), unknown elsewhere\n"
      "Options");
  auto add = known.add_options();
  add("file", po::value<std::string>()->required(), "the map; the first argument");
  add("output", po::value<std::string>()->required(), "the file to write; the second argument");
  add("full", ".edgevox: keep a full map full");
  add("occupied", ".ply, .pcd: all occupied voxels");
  addBandOptions(known);
  add("resolution", po::value<double>(), ".pgm: side of a cell [m] (default: that of the voxels)");
  return known;
}

/// Refuses the options that are of no use for the ending.
void requireOnly(const po::variables_map& given, const std::string& ending,
                 const std::vector<std::string>& options) {
  for (const char* option : {"full", "occupied", "from", "to", "resolution"}) {
    if (given.count(option) == 0) continue;
    if (std::find(options.begin(), options.end(), option) != options.end()) continue;
    throw UsageError(std::string("--") + option + " says nothing about a file " + ending);
  }
}

std::string contentOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void writeMap(const MapFile& file, const po::variables_map& given, const fs::path& output) {
  const bool is_full = file.head().content == MapContent::kFull;
  const bool stays_full = given.count("full") > 0;
  if (stays_full && !is_full) {
    throw MapFileError("the map '" + textOf(given, "file") +
                       "' is compact, of which no full one can be made: save a full one when "
                       "mapping (map_bag --full)");
  }
  const MatchMap map = file.matchMap();
  if (is_full == stays_full) {  // a second quantisation would lose a little
    writeFile(output, contentOf(textOf(given, "file")));
  } else {
    writeFile(output, mapFileBytes(map, file.config(), file.head().map_frame, file.head().scans));
  }
}

void writePoints(const MatchMap& map, bool occupied, const fs::path& output) {
  const bool ply = output.extension() == ".ply";
  if (occupied) {
    const auto centres = centresOf(allVoxels(map.hitVoxels()), map.voxelSize(0));
    ply ? writePly(output, centres) : writePcd(output, centres);
  } else {
    ply ? writeEdgesPly(output, map.edges()) : writeEdgesPcd(output, map.edges());
  }
}

void writeFloorPlan(const MatchMap& map, const po::variables_map& given, const fs::path& output) {
  if (given.count("from") == 0 || given.count("to") == 0) {
    throw UsageError("give --from and --to, the heights between which obstacles lie [m]");
  }
  const HeightBand band = bandOf(given);
  const double resolution = numberOf(given, "resolution").value_or(map.voxelSize(0));
  if (!(resolution >= 1e-3 && resolution <= 1e3)) {
    throw UsageError("--resolution must be 0.001 to 1000");
  }
  const FloorPlan plan = floorPlanOf(map.hitVoxels(), map.voxelSize(0), band, resolution);
  const fs::path image = fs::path(output).replace_extension(".pgm");
  writeFile(image, plan.pgm());
  writeFile(fs::path(output).replace_extension(".yaml"), plan.yaml(image.filename().string()));
}

}  // namespace

void mapConvert(const Arguments& arguments) {
  const auto given = parseOptions(arguments, describe(), {"file", "output"});
  if (!given) return;
  const fs::path output = textOf(*given, "output");
  const std::string ending = output.extension().string();
  if (ending == ".edgevox") {
    requireOnly(*given, ending, {"full"});
    writeMap(MapFile::read(textOf(*given, "file")), *given, output);
    return;
  }
  const auto map = [&] { return MapFile::read(textOf(*given, "file")).matchMap(); };
  if (ending == ".ply" || ending == ".pcd") {
    requireOnly(*given, ending, {"occupied"});
    writePoints(map(), given->count("occupied") > 0, output);
  } else if (ending == ".bt") {
    requireOnly(*given, ending, {});
    const MatchMap read = map();
    writeFile(output, octomapBytes(read.hitVoxels(), read.voxelSize(0)));
  } else if (ending == ".pgm" || ending == ".yaml") {
    requireOnly(*given, ending, {"from", "to", "resolution"});
    writeFloorPlan(map(), *given, output);
  } else {
    throw UsageError("'" + output.string() +
                     "' must end in .edgevox, .ply, .pcd, .bt, .pgm or .yaml");
  }
}

}  // namespace edgevox
