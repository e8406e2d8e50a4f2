// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "edgevox/io/atomic_file.hpp"
#include "edgevox/io/map_file.hpp"
#include "support/temp_folder.hpp"
#include "support/two_maps.hpp"
#include "support/voxel_sets.hpp"
#include "tools/map/subcommands.hpp"

namespace edgevox::test {

struct Outcome {
  int exit_code;
  std::string output;
  std::string errors;
};

/// What the program does with these arguments.
inline Outcome runMap(const std::vector<std::string>& arguments) {
  std::vector<const char*> argv = {"map"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  const int exit_code = runTool("map", static_cast<int>(argv.size()), argv.data(), runMapTool);
  return {exit_code, ::testing::internal::GetCapturedStdout(),
          ::testing::internal::GetCapturedStderr()};
}

inline std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// A map of these voxels, without edges and surfaces, in cells of the default size.
inline MatchMap mapOf(const Voxels& voxels) {
  MatchMap map(Config().voxel_size, Config().map.coarsest_voxel);
  for (const VoxelIndex& v : voxels) {
    map.hitVoxels().set(v);
    for (int l = 1; l < map.levels(); ++l) map.occupied(l).set(coarser(v, l));
  }
  return map;
}

/// A folder with maps a.edgevox and b.edgevox of two parts of a walk and full.edgevox, which is a
/// with all that mapping needs.
class MapToolTest : public ::testing::Test {
 protected:
  MapToolTest() {
    const Config config;
    save("a", mapFileBytes(MapContent::kCompact, maps().a, config, "map"));
    save("b", mapFileBytes(MapContent::kCompact, maps().b, config, "map"));
    save("full", mapFileBytes(MapContent::kFull, maps().a, config, "map"));
  }

  static const TwoMaps& maps() {
    static const TwoMaps made{Config{}};
    return made;
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string file(const std::string& map) const { return path(map + ".edgevox"); }
  void save(const std::string& map, const std::string& bytes) const { writeFile(file(map), bytes); }
  void save(const std::string& map, const Voxels& voxels) const {
    save(map, mapFileBytes(mapOf(voxels), Config{}, "map", 1));
  }
  MatchMap read(const std::string& map) const { return MapFile::read(file(map)).matchMap(); }

  std::vector<std::string> filesThere() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  static void expectRefused(const std::vector<std::string>& arguments, int exit_code,
                            const std::string& words) {
    const Outcome outcome = runMap(arguments);
    EXPECT_EQ(exit_code, outcome.exit_code) << arguments[0];
    EXPECT_NE(std::string::npos, outcome.errors.find(words)) << outcome.errors;
    EXPECT_EQ(0U, outcome.errors.find("map: ")) << outcome.errors;
  }

  TempFolder folder_;
};

}  // namespace edgevox::test
