// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <string>
#include <vector>

#include "edgevox/io/atomic_file.hpp"
#include "edgevox/io/map_file.hpp"
#include "edgevox/io/number_text.hpp"
#include "run/map_files.hpp"
#include "tools/map/map_points.hpp"
#include "tools/map/subcommands.hpp"
#include "tools/plot.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;

constexpr size_t kMostPixels = 20000;

po::options_description describe() {
  po::options_description known = withHelp(
      "Usage: map draw FILE --output PICTURE.png [options]\n"
      "Draws a map from above, x to the right and y up: edges coloured by height, of several\n"
      "above one another the highest; other occupied voxels in grey. Needs matplotlib.\nOptions");
  auto add = known.add_options();
  add("file", po::value<std::string>()->required(), "the map; the first argument");
  add("output,o", po::value<std::string>()->required(), "the picture to write, a PNG");
  addBandOptions(known);
  add("width", po::value<int64_t>()->default_value(1600), "of the picture [pixels]");
  return known;
}

}  // namespace

void mapDraw(const Arguments& arguments) {
  const auto given = parseOptions(arguments, describe(), "file");
  if (!given) return;
  const HeightBand band = bandOf(*given);
  const size_t width = countOf(*given, "width", 300);
  if (width > kMostPixels) throw UsageError("--width must be at most 20000");
  const MatchMap map = MapFile::read(textOf(*given, "file")).matchMap();
  const std::vector<EdgeVoxel> drawn = edgesIn(map, band);
  const auto centres = centresOf(allVoxels(map.hitVoxels()), map.voxelSize(0), band);
  if (drawn.empty() && centres.empty()) {
    throw FileError("nothing is drawn: the map has no voxels at these heights");
  }
  const fs::path output = textOf(*given, "output");
  AtomicFile picture(output);
  const AtomicFile edges(output);  // not kept: for the script to read
  const AtomicFile occupied(output);
  writeEdgesPly(edges.temporary(), drawn);
  writePly(occupied.temporary(), centres);
  if (!runScript("plot_map",
                 {edges.temporary(), occupied.temporary(), "--voxel-size",
                  shortText(map.voxelSize(0), 9), "--width", std::to_string(width), "--title",
                  textOf(*given, "file"), "--output", picture.temporary()})) {
    throw FileError("'" + output.string() + "' was not drawn");
  }
  picture.keep();
}

}  // namespace edgevox
