// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <iostream>

#include "edgevox/io/atomic_file.hpp"
#include "edgevox/io/trajectory_evaluation.hpp"
#include "evaluation/subjects.hpp"
#include "run/run_files.hpp"
#include "run/run_folder.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;

po::options_description describe() {
  po::options_description known = withHelp(
      "Usage: evaluate run FOLDER --reference TUM\n"
      "Compares FOLDER/trajectory.tum with a reference trajectory of the same frame: writes\n"
      "FOLDER/errors.csv and errors.json and prints the latter.\nOptions");
  auto add = known.add_options();
  add("folder", po::value<std::string>()->required(), "of map_bag or save_map; the first argument");
  add("reference", po::value<std::string>()->required(), "true trajectory, TUM format");
  return known;
}

}  // namespace

void evaluateRun(const Arguments& arguments) {
  const auto given = parseOptions(arguments, describe(), "folder");
  if (!given) return;
  const fs::path folder = (*given)["folder"].as<std::string>();
  RunFolder run(folder);
  run.check();
  const Trajectory estimate = readTum(folder / "trajectory.tum");
  const Trajectory reference = readTum((*given)["reference"].as<std::string>());
  const TrajectoryErrors errors = evaluate(estimate, reference);
  const std::string report = errorsReport(errors).json();
  writeFile(run.stage("errors.csv"), errorsCsv(errors));
  writeFile(run.stage("errors.json"), report);
  run.add();
  std::cout << report;
}

}  // namespace edgevox
