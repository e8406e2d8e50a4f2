// SPDX-License-Identifier: BSD-3-Clause
// Compares what a run has written with the truth.
#include <boost/program_options.hpp>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>

#include "edgevox/atomic_file.hpp"
#include "edgevox/trajectory_evaluation.hpp"
#include "run/run_files.hpp"

namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;

po::options_description describe() {
  po::options_description description(
      "Usage: evaluate run FOLDER --reference TUM\n"
      "Compares FOLDER/trajectory.tum with a reference trajectory of the same frame: writes\n"
      "FOLDER/errors.csv and prints the errors as JSON.\nOptions");
  auto add = description.add_options();
  add("help,h", "print this text");
  add("subject", po::value<std::string>()->required(), "run");
  add("folder", po::value<std::string>()->required(), "of map_bag or save_map");
  add("reference", po::value<std::string>()->required(), "true trajectory, TUM format");
  return description;
}

void evaluateRun(const fs::path& folder, const fs::path& reference) {
  const auto estimate = edgevox::readTum(folder / "trajectory.tum");
  const auto errors = edgevox::evaluate(estimate, edgevox::readTum(reference));
  edgevox::writeFile(folder / "errors.csv", edgevox::errorsCsv(errors));
  std::cout << edgevox::errorsReport(errors).json();
}

int run(int argc, char** argv) {
  const po::options_description known = describe();
  po::positional_options_description positional;
  positional.add("subject", 1).add("folder", 1);
  po::variables_map given;
  po::store(po::command_line_parser(argc, argv).options(known).positional(positional).run(), given);
  if (given.count("help") > 0) {
    std::cout << known;
    return 0;
  }
  po::notify(given);
  const auto subject = given["subject"].as<std::string>();
  if (subject != "run") throw po::error("'" + subject + "' is not known: run");
  evaluateRun(given["folder"].as<std::string>(), given["reference"].as<std::string>());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const po::error& error) {
    std::cerr << "evaluate: " << error.what() << "; see evaluate --help\n";
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "evaluate: " << error.what() << "\n";
    return 1;
  }
}
