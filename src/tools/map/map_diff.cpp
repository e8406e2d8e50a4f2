// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "edgevox/io/map_file.hpp"
#include "run/map_files.hpp"
#include "run/report.hpp"
#include "run/run_files.hpp"
#include "tools/map/map_points.hpp"
#include "tools/map/subcommands.hpp"

namespace edgevox {
namespace {

namespace po = boost::program_options;

constexpr int kMostWithin = 10;  // [voxels]; what is looked at grows with the cube

po::options_description describe() {
  po::options_description known = withHelp(
      "Usage: map diff A B [--within N] [--output FOLDER]\n"
      "Counts the occupied voxels and the edges that only one of two maps has, and those that\n"
      "both have: in_both are those of A. Both maps must be in one frame. The exit code is 0\n"
      "whether they differ or not.\nOptions");
  auto add = known.add_options();
  add("a", po::value<std::string>()->required(), "a map; the first argument");
  add("b", po::value<std::string>()->required(), "a map; the second argument");
  add("within", po::value<int64_t>()->default_value(1),
      "a voxel is in the other map, too, if that has one so many voxels from it on each axis");
  add("output,o", po::value<std::string>(),
      "folder for added.ply and removed.ply: centres of the occupied voxels that only B has, and "
      "only A; made if need be");
  add("json", "print JSON");
  return known;
}

bool holdsNear(BitReader<16>& grid, const VoxelIndex& v, int within) {
  if (grid.test(v)) return true;
  for (int z = -within; z <= within; ++z) {
    for (int y = -within; y <= within; ++y) {
      for (int x = -within; x <= within; ++x) {
        if (grid.test({v.x + x, v.y + y, v.z + z})) return true;
      }
    }
  }
  return false;
}

/// The voxels of a that have none of b near them.
std::vector<VoxelIndex> onlyIn(const BitGrid<16>& a, const BitGrid<16>& b, int within) {
  BitReader<16> other(b);
  std::vector<VoxelIndex> voxels;
  a.forEach([&](const VoxelIndex& v) {
    if (!holdsNear(other, v, within)) voxels.push_back(v);
  });
  return voxels;
}

struct Difference {
  std::vector<VoxelIndex> only_a;
  std::vector<VoxelIndex> only_b;
  Report counts;

  Difference(const BitGrid<16>& a, const BitGrid<16>& b, int within)
      : only_a(onlyIn(a, b, within)), only_b(onlyIn(b, a, within)) {
    counts.add("a", uint64_t{a.voxelCount()});
    counts.add("b", uint64_t{b.voxelCount()});
    counts.add("only_in_a", uint64_t{only_a.size()});
    counts.add("only_in_b", uint64_t{only_b.size()});
    counts.add("in_both", uint64_t{a.voxelCount() - only_a.size()});
  }
};

void requireComparable(const MapFile& a, const MapFile& b) {
  if (a.config().voxel_size != b.config().voxel_size) {
    throw ConfigError("the maps have voxels of different sizes and cannot be compared");
  }
  if (a.head().map_frame != b.head().map_frame) {
    throw ConfigError("the maps are in different frames, '" + a.head().map_frame + "' and '" +
                      b.head().map_frame + "', and cannot be compared");
  }
}

}  // namespace

void mapDiff(const Arguments& arguments) {
  const auto given = parseOptions(arguments, describe(), {"a", "b"});
  if (!given) return;
  const auto within = static_cast<int>(std::min(countOf(*given, "within", 0), size_t{1000}));
  if (within > kMostWithin) {
    throw UsageError("--within must be at most " + std::to_string(kMostWithin));
  }
  const MapFile file_a = MapFile::read(textOf(*given, "a"));
  const MapFile file_b = MapFile::read(textOf(*given, "b"));
  requireComparable(file_a, file_b);
  const MatchMap a = file_a.matchMap();
  const MatchMap b = file_b.matchMap();
  const Difference occupied(a.hitVoxels(), b.hitVoxels(), within);
  Report report;
  report.add("occupied", occupied.counts);
  report.add("edges", Difference(a.edgeVoxels(), b.edgeVoxels(), within).counts);
  if (given->count("output") > 0) {
    const std::filesystem::path folder = textOf(*given, "output");
    makeFolder(folder);
    writePly(folder / "added.ply", centresOf(occupied.only_b, a.voxelSize(0)));
    writePly(folder / "removed.ply", centresOf(occupied.only_a, a.voxelSize(0)));
  }
  std::cout << (given->count("json") > 0 ? report.json() : report.table());
}

}  // namespace edgevox
