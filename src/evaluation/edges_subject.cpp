// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <iostream>

#include "evaluation/edge_measures.hpp"
#include "evaluation/subjects.hpp"
#include "run/run_files.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;

using Sizes = std::vector<double>;

po::options_description describe() {
  po::options_description known = withHelp(
      "Usage: evaluate edges INPUT --output FOLDER [options]\n"
      "Measures how edges are extracted from scans and labelled in the map: compression,\n"
      "repeatability, time, and in simulated worlds precision, coverage, the causes of false\n"
      "edges, and what the map keeps of things that are gone. Writes FOLDER/edges.md, edges.csv\n"
      "and edges.png and prints the first.\nOptions");
  addRecordingOptions(known);
  addConfigOptions(known);
  auto add = known.add_options();
  add("output,o", po::value<std::string>()->required(), "folder for the results; made if need be");
  add("voxel-sizes", po::value<Sizes>()->multitoken(), "of the map, m (default: 0.05 0.1 0.2 0.4)");
  add("pair-step", po::value<int64_t>()->default_value(5),
      "repeatability is between scans i and i + N of those taken");
  add("detectors", po::bool_switch(),
      "also by PCA of points, difference of Gaussians, Haar-like features, Harris 3D (PCL)");
  return known;
}

EdgeMeasureOptions measureOptionsOf(const po::variables_map& given) {
  EdgeMeasureOptions options;
  if (given.count("voxel-sizes") > 0) options.voxel_sizes = given["voxel-sizes"].as<Sizes>();
  for (const double size : options.voxel_sizes) {
    if (size >= 0.01 && size <= 10.0) continue;
    throw UsageError("--voxel-sizes must be 0.01 to 10 m");
  }
  options.config = configOf(given, options.config_name);
  options.detectors = given["detectors"].as<bool>();
  options.pair_step = countOf(given, "pair-step", 1);
  return options;
}

}  // namespace

void evaluateEdges(const Arguments& arguments) {
  const auto given = parseOptions(arguments, describe(), "input");
  if (!given) return;
  const EdgeMeasureOptions options = measureOptionsOf(*given);
  const fs::path folder = (*given)["output"].as<std::string>();
  const Recording recording = makeRecording(recordingOptionsOf(*given));
  makeFolder(folder);
  const Table table = measureEdges(recording, options, [](const std::string& note) {
    std::cerr << "evaluate: " << note << "\n";
  });
  writeResults(folder, "edges", "plot_edges", table, edgesMarkdown(recording, options, table));
}

}  // namespace edgevox
