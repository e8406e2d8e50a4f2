// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <iostream>

#include "evaluation/map_measures.hpp"
#include "evaluation/subjects.hpp"
#include "run/run_files.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;

po::options_description describe() {
  po::options_description known = withHelp(
      "Usage: evaluate map INPUT --output FOLDER [options]\n"
      "Maps a recording with maps of many sizes and measures error and capture against their\n"
      "bytes: of planes with edges and flat anchors, with as many voxels by chance, and with all\n"
      "voxels. Writes FOLDER/map.md, map.csv and map.png and prints the first.\nOptions");
  addRecordingOptions(known);
  addConfigOptions(known);
  auto add = known.add_options();
  add("output,o", po::value<std::string>()->required(), "folder for the results; made if need be");
  add("anchors", po::value<std::vector<int>>()->multitoken(),
      "values of map/anchors (default: 2 4 8 16 32)");
  return known;
}

MapMeasureOptions measureOptionsOf(const po::variables_map& given) {
  MapMeasureOptions options;
  options.config = configOf(given, options.config_name);
  if (given.count("anchors") > 0) options.anchors = given["anchors"].as<std::vector<int>>();
  for (const int anchors : options.anchors) {
    if (anchors < 1 || anchors > 1000) {
      throw UsageError("--anchors must be 1 to 1000");
    }
  }
  return options;
}

}  // namespace

void evaluateMap(const Arguments& arguments) {
  const auto given = parseOptions(arguments, describe(), "input");
  if (!given) return;
  const MapMeasureOptions options = measureOptionsOf(*given);
  const fs::path folder = (*given)["output"].as<std::string>();
  const Recording recording = makeRecording(recordingOptionsOf(*given));
  makeFolder(folder);
  const Table table = measureMaps(recording, options, [](const std::string& note) {
    std::cerr << "evaluate: " << note << "\n";
  });
  writeResults(folder, "map", "plot_maps", table, mapMarkdown(recording, options, table));
}

}  // namespace edgevox
