// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <string>

#include "edgevox/io/atomic_file.hpp"
#include "edgevox/io/map_file.hpp"
#include "edgevox/map/map_union.hpp"
#include "tools/map/subcommands.hpp"

namespace edgevox {
namespace {

namespace po = boost::program_options;

po::options_description describe() {
  po::options_description known = withHelp(
      "Usage: map merge A B --output MAP.edgevox\n"
      "Writes a compact map of what is occupied or an edge in either map. Where both have a\n"
      "surface to align scans to, that of A stays; edges are not looked for anew. Both must have\n"
      "been built with the same parameters and in one frame, as with the same odometry: maps are\n"
      "not moved, as voxels cannot be turned without loss.\nOptions");
  auto add = known.add_options();
  add("a", po::value<std::string>()->required(), "a map; the first argument");
  add("b", po::value<std::string>()->required(), "a map; the second argument");
  add("output,o", po::value<std::string>()->required(), "the file to write");
  return known;
}

}  // namespace

void mapMerge(const Arguments& arguments) {
  const auto given = parseOptions(arguments, describe(), {"a", "b"});
  if (!given) return;
  const MapFile a = MapFile::read(textOf(*given, "a"));
  const MapFile b = MapFile::read(textOf(*given, "b"));
  a.requireSameMap(b);
  const MatchMap map = unionOf(a.matchMap(), b.matchMap(), a.config().map.representation);
  writeFile(textOf(*given, "output"),
            mapFileBytes(map, a.config(), a.head().map_frame, a.head().scans + b.head().scans));
  std::cout << textOf(*given, "output") << ": " << map.hitVoxels().voxelCount()
            << " occupied voxels, " << map.edges().size() << " edges\n";
}

}  // namespace edgevox
