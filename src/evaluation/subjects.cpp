// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/subjects.hpp"

#include <iostream>
#include <stdexcept>

#include "edgevox/io/atomic_file.hpp"
#include "evaluation/plot.hpp"
#include "tools/config_file.hpp"

namespace edgevox {
namespace {

namespace po = boost::program_options;

using Texts = std::vector<std::string>;

size_t countOf(const po::variables_map& given, const char* name, int64_t least) {
  const auto count = given[name].as<int64_t>();
  if (count >= least) return static_cast<size_t>(count);
  throw std::invalid_argument(std::string("--") + name + " must be at least " +
                              std::to_string(least));
}

}  // namespace

std::optional<po::variables_map> parseArguments(const Arguments& arguments,
                                                const po::options_description& known,
                                                const char* positional) {
  po::positional_options_description position;
  position.add(positional, 1);
  namespace style = po::command_line_style;
  po::variables_map given;
  po::store(po::command_line_parser(arguments)
                .options(known)
                .positional(position)
                .style(style::unix_style & ~style::allow_guessing)
                .run(),
            given);
  if (given.count("help") > 0) {
    std::cout << known;
    return std::nullopt;
  }
  po::notify(given);
  return given;
}

void addRecordingOptions(po::options_description& known) {
  auto add = known.add_options();
  add("help,h", "print this text");
  add("input", po::value<std::string>()->required(),
      "a bag, or WORLD:SENSOR[:SEED] to simulate (building, street or corridor; 16, 32, 64 or "
      "scanner), as in building:32; building+movers:32 if people are to walk about and boxes to be "
      "taken away; the first argument");
  add("topic", po::value<std::string>()->default_value("", "the only one with clouds"),
      "of a bag's clouds");
  add("poses", po::value<std::string>()->default_value("", "those that map_bag would find"),
      "of a bag's sensor at the clouds' stamps, TUM format");
  add("first", po::value<int64_t>()->default_value(0), "begin with this scan, counted from 0");
  add("every", po::value<int64_t>()->default_value(1), "take every N-th scan from there on");
  add("scans", po::value<int64_t>()->default_value(100), "take so many scans at most");
}

void addConfigOptions(po::options_description& known) {
  auto add = known.add_options();
  add("config", po::value<std::string>()->default_value("", "the built-in values"),
      "indoor, outdoor, terrestrial, or a YAML file");
  add("set", po::value<Texts>()->multitoken(), "name=value ..., parameters of the configuration");
}

Config configOf(const po::variables_map& given, std::string& name) {
  Config config;
  const auto file = given["config"].as<std::string>();
  if (!file.empty()) {
    applyConfigFile(findConfigFile(file), config);
    name = file;
  }
  if (given.count("set") > 0) {
    for (const std::string& setting : given["set"].as<Texts>()) {
      applySetting(setting, config);
      name += " " + setting;
    }
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
