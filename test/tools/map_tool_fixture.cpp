// SPDX-License-Identifier: BSD-3-Clause
#include "tools/map_tool_fixture.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "edgevox/config.hpp"
#include "edgevox/io/atomic_file.hpp"
#include "edgevox/io/map_file.hpp"
#include "tools/map/subcommands.hpp"

namespace edgevox::test {

Outcome runMap(const std::vector<std::string>& arguments) {
  std::vector<const char*> argv = {"map"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  const int exit_code = runTool("map", static_cast<int>(argv.size()), argv.data(), runMapTool);
  return {exit_code, ::testing::internal::GetCapturedStdout(),
          ::testing::internal::GetCapturedStderr()};
}

std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

MatchMap mapOf(const Voxels& voxels) {
  MatchMap map(Config().voxel_size, Config().map.coarsest_voxel);
  for (const VoxelIndex& v : voxels) {
    map.hitVoxels().set(v);
    for (int l = 1; l < map.levels(); ++l) map.occupied(l).set(coarser(v, l));
  }
  return map;
}

MapToolTest::MapToolTest() {
  const Config config;
  save("a", mapFileBytes(MapContent::kCompact, maps().a, config, "map"));
  save("b", mapFileBytes(MapContent::kCompact, maps().b, config, "map"));
  save("full", mapFileBytes(MapContent::kFull, maps().a, config, "map"));
}

MapToolTest::~MapToolTest() = default;

const TwoMaps& MapToolTest::maps() {
  static const TwoMaps made{Config{}};
  return made;
}

void MapToolTest::save(const std::string& map, const std::string& bytes) const {
  writeFile(file(map), bytes);
}

void MapToolTest::save(const std::string& map, const Voxels& voxels) const {
  save(map, mapFileBytes(mapOf(voxels), Config{}, "map", 1));
}

MatchMap MapToolTest::read(const std::string& map) const {
  return MapFile::read(file(map)).matchMap();
}

std::vector<std::string> MapToolTest::filesThere() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

void MapToolTest::expectRefused(const std::vector<std::string>& arguments, int exit_code,
                                const std::string& words) {
  const Outcome outcome = runMap(arguments);
  EXPECT_EQ(exit_code, outcome.exit_code) << arguments[0];
  EXPECT_NE(std::string::npos, outcome.errors.find(words)) << outcome.errors;
  EXPECT_EQ(0U, outcome.errors.find("map: ")) << outcome.errors;
}

}  // namespace edgevox::test
