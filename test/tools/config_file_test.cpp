// SPDX-License-Identifier: BSD-3-Clause
#include "tools/config_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "support/temp_folder.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;

Config parsed(const std::string& text) {
  Config config;
  applyYaml(text, "my.yaml", config);
  return config;
}

template <typename Call>
void expectError(const Call& call, const std::vector<std::string>& words) {
  try {
    call();
    ADD_FAILURE() << "no error; expected " << words.front();
  } catch (const ConfigError& error) {
    for (const std::string& word : words) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
          << "'" << word << "' in: " << error.what();
    }
  }
}

void expectYamlError(const std::string& text, const std::vector<std::string>& words) {
  expectError([&] { parsed(text); }, words);
}

TEST(ConfigFile, setsNestedGroups) {
  const Config config = parsed(
      "# comment\nvoxel_size: 0.25\nthreads: 2\nmap:\n  representation: all\n  min_hits: 3\n");
  EXPECT_EQ(config.voxel_size, 0.25);
  EXPECT_EQ(config.threads, 2);
  EXPECT_EQ(config.map.representation, Representation::kAll);
  EXPECT_EQ(config.map.min_hits, 3);
  EXPECT_EQ(config.map.label_every, Config().map.label_every);
}

TEST(ConfigFile, emptyFileAndEmptyGroupChangeNothing) {
  EXPECT_EQ(yamlText(parsed("")), yamlText(Config()));
  EXPECT_EQ(yamlText(parsed("# nothing\n")), yamlText(Config()));
  EXPECT_EQ(yamlText(parsed("map:\n")), yamlText(Config()));
}

TEST(ConfigFile, unknownNamesGetTheNearest) {
  expectYamlError("voxel_sise: 0.1\n", {"my.yaml, line 1", "'voxel_sise'", "'voxel_size'"});
  expectYamlError("threads: 1\nmap:\n  min_hit: 2\n",
                  {"my.yaml, line 3", "'map/min_hit'", "'map/min_hits'"});
  expectYamlError("min_hits: 2\n", {"'min_hits'", "'map/min_hits'"});
  expectYamlError("matcher:\n  coarsest_voxel: 3.2\n",
                  {"line 2", "'matcher/coarsest_voxel'", "did you mean 'map/coarsest_voxel'"});
  expectYamlError("edges: {ratio: 0.2}\n", {"'edges/ratio'", "did you mean 'edges/scan_ratio'"});
  expectYamlError("matchr:\n  max_restarts: 2\n", {"'matchr'", "'matcher/"});
}

TEST(ConfigFile, badValuesAreNamed) {
  expectYamlError("voxel_size: 0\n", {"line 1", "'voxel_size' is '0'", "0.01 to 10 m"});
  expectYamlError("voxel_size: wide\n", {"'voxel_size' is 'wide'"});
  expectYamlError("voxel_size: .nan\n", {"'voxel_size'"});
  expectYamlError("threads: 1.5\n", {"'threads' is '1.5'", "whole number"});
  expectYamlError("\nmap: {representation: flat}\n",
                  {"line 2", "'map/representation' is 'flat'", "sparse, all, random, edges"});
  expectYamlError("voxel_size: [0.1]\n", {"'voxel_size'"});
  expectYamlError("voxel_size: {value: 0.1}\n", {"'voxel_size'"});
  expectYamlError("voxel_size:\n", {"'voxel_size' is ''"});
}

TEST(ConfigFile, badStructureIsNamed) {
  expectYamlError("map: 3\n", {"'map' is a group"});
  expectYamlError("- voxel_size\n", {"my.yaml", "name: value"});
  expectYamlError("just words\n", {"my.yaml", "name: value"});
  expectYamlError("voxel_size: 0.1\nvoxel_size: 0.2\n", {"line 2", "given twice"});
  expectYamlError("voxel_size: 0.1\nmap: {\n", {"my.yaml, line"});
  expectYamlError("[1]: 2\n", {"my.yaml, line 1"});
}

TEST(ConfigFile, rangesMustBeInOrder) {
  expectYamlError("voxelizer: {min_range: 50, max_range: 10}\n",
                  {"my.yaml", "'voxelizer/min_range'"});
}

TEST(ConfigFile, settings) {
  Config config;
  applySetting("matcher/mode=published", config);
  EXPECT_EQ(config.matcher.mode, MatcherMode::kPublished);
  expectError([&] { applySetting("matcher/mode", config); }, {"name=value"});
  expectError([&] { applySetting("=3", config); }, {"name=value"});
  expectError([&] { applySetting("theads=3", config); }, {"'theads'", "'threads'"});
  expectError([&] { applySetting("threads=0", config); }, {"'threads' is '0'"});
}

TEST(ConfigFile, textHasAllParametersAndReadsBack) {
  Config config;
  config.voxel_size = 0.123456789;
  config.edges.mode = EdgeMode::kPaper;
  config.mapper.fallback_matches = 17;
  const std::string text = yamlText(config);
  const Config read = parsed(text);
  EXPECT_EQ(read.voxel_size, config.voxel_size);
  EXPECT_EQ(yamlText(read), text);
  for (const Parameter& parameter : parametersOf(config)) {
    const std::string last = parameter.name.substr(parameter.name.rfind('/') + 1);
    if (last == "threads") continue;
    EXPECT_NE(text.find(last + ": " + valueText(parameter) + "\n"), std::string::npos) << last;
  }
}

TEST(ConfigFile, theTextDoesNotDependOnTheNumberOfThreads) {
  Config config;
  config.threads = 4;
  EXPECT_EQ(yamlText(config), yamlText(Config()));
}

TEST(ConfigFile, presets) {
  Config indoor;
  applyConfigFile(findConfigFile("indoor"), indoor);
  Config outdoor;
  applyConfigFile(findConfigFile("outdoor"), outdoor);
  EXPECT_GT(outdoor.voxel_size, indoor.voxel_size);
  Config terrestrial;
  applyConfigFile(findConfigFile("terrestrial"), terrestrial);
  EXPECT_LT(terrestrial.voxel_size, indoor.voxel_size);
  Config paper;
  applyConfigFile(findConfigFile("paper"), paper);
  EXPECT_EQ(0.05, paper.voxel_size);
  EXPECT_EQ(EdgeMode::kPaper, paper.edges.mode);
  EXPECT_EQ(MatcherMode::kPublished, paper.matcher.mode);
  EXPECT_EQ(ScanVoxels::kEdges, paper.mapper.scan_voxels);
}

TEST(ConfigFile, unknownPresetListsThoseThereAre) {
  expectError([] { findConfigFile("indor"); }, {"'indor'", "indoor, outdoor, paper, terrestrial"});
}

TEST(ConfigFile, filesByName) {
  const test::TempFolder folder;
  const std::string file = (folder / "mine.yaml").string();
  std::ofstream(file) << "threads: 3\n";
  Config config;
  applyConfigFile(findConfigFile(file), config);
  EXPECT_EQ(config.threads, 3);
  expectError([&] { applyConfigFile(findConfigFile("no/such.yaml"), config); }, {"'no/such.yaml'"});
  expectError([&] { applyConfigFile(folder.path(), config); }, {folder.path().string()});
}

}  // namespace
}  // namespace edgevox
