// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "edgevox/map/match_map.hpp"
#include "support/temp_folder.hpp"
#include "support/two_maps.hpp"
#include "support/voxel_sets.hpp"

namespace edgevox::test {

struct Outcome {
  int exit_code;
  std::string output;
  std::string errors;
};

/// What the program does with these arguments.
Outcome runMap(const std::vector<std::string>& arguments);

std::string bytesOf(const std::filesystem::path& file);

/// A map of these voxels, without edges and surfaces, in cells of the default size.
MatchMap mapOf(const Voxels& voxels);

/// A folder with maps a.edgevox and b.edgevox of two parts of a walk and full.edgevox, which is a
/// with all that mapping needs.
class MapToolTest : public ::testing::Test {
 protected:
  MapToolTest();
  ~MapToolTest() override;

  static const TwoMaps& maps();

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string file(const std::string& map) const { return path(map + ".edgevox"); }
  void save(const std::string& map, const std::string& bytes) const;
  void save(const std::string& map, const Voxels& voxels) const;
  MatchMap read(const std::string& map) const;

  std::vector<std::string> filesThere() const;

  static void expectRefused(const std::vector<std::string>& arguments, int exit_code,
                            const std::string& words);

  TempFolder folder_;
};

}  // namespace edgevox::test
