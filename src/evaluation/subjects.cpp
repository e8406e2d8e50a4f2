// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/subjects.hpp"

#include <iostream>

#include "edgevox/io/atomic_file.hpp"
#include "tools/config_file.hpp"
#include "tools/plot.hpp"

namespace edgevox {

namespace po = boost::program_options;

void addRecordingOptions(po::options_description& known) {
  auto add = known.add_options();
  add("input", po::value<std::string>()->required(),
      "a bag, a folder of scans, or WORLD:SENSOR[:SEED] to simulate (building, street, corridor or "
      "city; 16, 32, 64, scanner or fine-scanner), as in building:32; building+movers:32 if people "
      "are to walk about and boxes to be taken away; the first argument");
  add("topic", po::value<std::string>()->default_value("", "the only one with clouds"),
      "of a bag's clouds");
  add("poses", po::value<std::string>()->default_value("", "those that map_bag would find"),
      "of a bag's sensor at the clouds' stamps, TUM format; or of the scans of a folder");
  add("first", po::value<int64_t>()->default_value(0), "begin with this scan, counted from 0");
  add("every", po::value<int64_t>()->default_value(1), "take every N-th scan from there on");
  add("scans", po::value<int64_t>()->default_value(100), "take so many scans at most");
}

void addConfigOptions(po::options_description& known) {
  auto add = known.add_options();
  add("config", po::value<std::string>()->default_value("", "the built-in values"),
      "indoor, outdoor, terrestrial, paper, or a YAML file");
  add("set", po::value<std::vector<std::string>>()->multitoken(),
      "name=value ..., parameters of the configuration");
}

Config configOf(const po::variables_map& given, std::string& name, Config config) {
  const auto file = given["config"].as<std::string>();
  if (!file.empty()) {
    applyConfigFile(findConfigFile(file), config);
    name = file;
  }
  for (const std::string& setting : textsOf(given, "set")) {
    applySetting(setting, config);
    name += " " + setting;
  }
  validate(config);
  return config;
}

RecordingOptions recordingOptionsOf(const po::variables_map& given) {
  RecordingOptions options;
  options.input = given["input"].as<std::string>();
  options.topic = given["topic"].as<std::string>();
  options.poses = given["poses"].as<std::string>();
  options.first = countOf(given, "first", 0);
  options.every = countOf(given, "every", 1);
  options.most = countOf(given, "scans", 1);
  return options;
}

void writeResults(const std::filesystem::path& folder, const std::string& name,
                  const std::string& script, const Table& table, const std::string& markdown) {
  const auto csv = folder / (name + ".csv");
  const auto picture = folder / (name + ".png");
  writeFile(csv, table.csv());
  writeFile(folder / (name + ".md"), markdown);
  std::cout << markdown;
  if (!runScript(script, {csv, "--output", picture})) {
    std::cerr << "evaluate: " << picture.filename().string() << " was not drawn\n";
  }
}

}  // namespace edgevox
