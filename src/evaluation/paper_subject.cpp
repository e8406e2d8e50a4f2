// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "edgevox/io/atomic_file.hpp"
#include "evaluation/paper_report.hpp"
#include "evaluation/scan_stream.hpp"
#include "evaluation/subjects.hpp"
#include "run/run_files.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;

constexpr double kVoxelSize = 0.05;  // [m]

po::options_description describe() {
  po::options_description known = withHelp(
      "Usage: evaluate paper INPUT --output FOLDER [options]\n"
      "Runs the comparison of Ryde, Delmerico and Corso: ICP from scan to scan and MROL from scan\n"
      "to map, on all voxels and on edge voxels, and edgevox, from guesses that are wrong by a\n"
      "random error. Writes FOLDER/paper.md, paper.csv, ratios.csv and paper.png and prints the\n"
      "first. Each method runs in a process of its own.\nOptions");
  addRecordingOptions(known);
  auto add = known.add_options();
  add("seed", po::value<int64_t>()->default_value(1), "of the errors of the guesses");
  add("distance", po::value<double>()->default_value(0.5, "0.5"),
      "standard deviation of the guesses on each axis, in metres");
  add("angle", po::value<double>()->default_value(10.0, "10"), "the same, in degrees");
  add("seconds", po::value<double>()->default_value(600.0, "600"),
      "CPU time after which a method is ended");
  add("megabytes", po::value<int64_t>()->default_value(8192), "memory that a method may take");
  add("methods", po::value<std::vector<std::string>>()->multitoken(),
      "those whose names begin so, as in MROL edgevox (default: all)");
  addConfigOptions(known);
  add("output,o", po::value<std::string>()->required(), "folder for the results; made if need be");
  return known;
}

double notNegative(const po::variables_map& given, const char* name) {
  const double value = given[name].as<double>();
  if (!(value >= 0 && value < 1e9)) {
    throw UsageError(std::string("--") + name + " must be a number from 0 on");
  }
  return value;
}

PaperOptions paperOptionsOf(const po::variables_map& given) {
  PaperOptions options;
  options.config.voxel_size = kVoxelSize;
  options.config = configOf(given, options.config_name, options.config);
  options.recording = recordingOptionsOf(given);
  options.seed = countOf(given, "seed", 0);
  options.error.distance = notNegative(given, "distance");
  options.error.angle = notNegative(given, "angle");
  options.seconds = notNegative(given, "seconds");
  options.megabytes = countOf(given, "megabytes", 64);
  return options;
}

std::vector<NamedPaperMethod> methodsOf(const po::variables_map& given,
                                        const PaperOptions& options) {
  std::vector<NamedPaperMethod> methods = paperMethods(options.config, options.error);
  const std::vector<std::string> wanted = textsOf(given, "methods");
  if (wanted.empty()) return methods;
  const auto isWanted = [&](const NamedPaperMethod& method) {
    return std::any_of(wanted.begin(), wanted.end(),
                       [&](const std::string& name) { return method.name.rfind(name, 0) == 0; });
  };
  methods.erase(std::remove_if(methods.begin(), methods.end(),
                               [&](const auto& method) { return !isWanted(method); }),
                methods.end());
  if (methods.empty()) throw UsageError("--methods names none: they begin with ICP, MROL, edgevox");
  return methods;
}

}  // namespace

void evaluatePaper(const Arguments& arguments) {
  const auto given = parseOptions(arguments, describe(), "input");
  if (!given) return;
  const PaperOptions options = paperOptionsOf(*given);
  const std::vector<NamedPaperMethod> methods = methodsOf(*given, options);
  const fs::path folder = (*given)["output"].as<std::string>();
  const RecordingOptions& recording = options.recording;
  const ScanStream scans = streamOf(recording.input, recording.poses, recording.topic);
  makeFolder(folder);
  std::vector<PaperRow> rows;
  for (const NamedPaperMethod& method : methods) {  // before there are threads, as they fork
    std::cerr << "evaluate: " << method.name << "\n";
    rows.push_back(runPaperMethod(method, scans, options));
  }
  const PaperData data = measureData(scans, options);
  writeFile(folder / "ratios.csv", paperRatios(data).csv());
  writeResults(folder, "paper", "plot_paper", paperScans(rows),
               paperMarkdown(recordingName(recording.input), data, rows, options));
}

}  // namespace edgevox
