// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <limits>
#include <thread>

#include "evaluation/list_option.hpp"
#include "evaluation/subjects.hpp"
#include "evaluation/trust_matrix.hpp"
#include "evaluation/trust_report.hpp"
#include "run/run_files.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;

constexpr const char* kNoWorlds = "none";

po::options_description describe() {
  po::options_description known = withHelp(
      "Usage: evaluate trust --output FOLDER [options]\n"
      "Maps many recordings, each with every scan, every third, and so on, and counts the scans\n"
      "that are right, wrong without being told, and lost. Writes FOLDER/trust.md, trust.csv and\n"
      "trust.png and prints the first. The whole matrix takes hours; narrow it by the options.\n"
      "Options");
  auto add = known.add_options();
  add("worlds", po::value<std::string>()->default_value("building,street,corridor"),
      "to simulate: building, building+movers, street, corridor; or 'none'");
  add("beams", po::value<std::string>()->default_value("16,32,64"), "of the simulated lidars");
  add("seeds", po::value<std::string>()->default_value("1-9"),
      "of the simulated worlds: a list, with ranges");
  add("strides", po::value<std::string>()->default_value("1,3,5,8"),
      "map every n-th scan, for each n of this list");
  add("bag", po::value<std::vector<std::string>>()->multitoken()->composing(),
      "FILE[=TUM] ..., bags with one topic of clouds, and the trajectories of their sensors; "
      "without one, a bag is compared with what the default configuration finds from all clouds");
  add("most", po::value<int64_t>()->default_value(std::numeric_limits<int64_t>::max(), "all"),
      "take so many scans of a recording at most, counted before strides");
  add("jobs,j",
      po::value<int64_t>()->default_value(std::max(1U, std::thread::hardware_concurrency()),
                                          "the processors"),
      "recordings at a time; the results do not depend on it");
  addConfigOptions(known);
  add("output,o", po::value<std::string>()->required(), "folder for the results; made if need be");
  return known;
}

std::vector<size_t> numbersGiven(const po::variables_map& given, const char* name, size_t least) {
  return numbersOf(given[name].as<std::string>(), name, least);
}

void addSimulated(const po::variables_map& given, std::vector<TrustRecording>& recordings) {
  const auto worlds = given["worlds"].as<std::string>();
  if (worlds == kNoWorlds) return;
  const auto sensors = wordsOf(given["beams"].as<std::string>(), "beams");
  const auto seeds = numbersGiven(given, "seeds", 0);
  for (const std::string& world : wordsOf(worlds, "worlds")) {
    for (const std::string& sensor : sensors) {
      for (const size_t seed : seeds) {
        const std::string name = world + ":" + sensor + ":" + std::to_string(seed);
        recordings.push_back({name, world, sensor, seed, simulatedStream(name)});
      }
    }
  }
}

void addBag(const std::string& text, std::vector<TrustRecording>& recordings) {
  const size_t equals = fs::exists(text) ? std::string::npos : text.rfind('=');
  const fs::path bag = text.substr(0, equals);
  const std::string poses = equals == std::string::npos ? "" : text.substr(equals + 1);
  const std::string name = bag.filename().string();
  if (!Table::isText(name)) throw UsageError("no name for a table: '" + name + "'; rename the bag");
  recordings.push_back({name, "", "", 0, bagStream(bag, poses)});
}

std::vector<TrustRecording> recordingsOf(const po::variables_map& given) {
  std::vector<TrustRecording> recordings;
  addSimulated(given, recordings);
  for (const std::string& bag : textsOf(given, "bag")) addBag(bag, recordings);
  if (recordings.empty()) throw UsageError("name --worlds or a --bag");
  return recordings;
}

TrustOptions trustOptionsOf(const po::variables_map& given) {
  TrustOptions options;
  options.config = configOf(given, options.config_name);
  options.strides = numbersGiven(given, "strides", 1);
  options.most = countOf(given, "most", 1);
  options.threads = static_cast<int>(std::min<size_t>(countOf(given, "jobs", 1), 1000));
  return options;
}

}  // namespace

void evaluateTrust(const Arguments& arguments) {
  const auto given = parseOptions(arguments, describe());
  if (!given) return;
  const TrustOptions options = trustOptionsOf(*given);
  const std::vector<TrustRecording> recordings = recordingsOf(*given);
  const fs::path folder = (*given)["output"].as<std::string>();
  makeFolder(folder);
  const auto cells = runMatrix(recordings, options, [](const std::string& note) {
    std::cerr << "evaluate: " << note << "\n";
  });
  writeResults(folder, "trust", "plot_trust", trustTable(recordings, cells),
               trustMarkdown(recordings, cells, options));
}

}  // namespace edgevox
