// SPDX-License-Identifier: BSD-3-Clause
#include "tools/map_bag_options.hpp"

#include <algorithm>
#include <boost/program_options.hpp>
#include <cctype>
#include <iostream>

#include "tools/config_file.hpp"

namespace edgevox {
namespace {

namespace po = boost::program_options;

po::options_description describe() {
  using Text = std::string;
  using Texts = std::vector<std::string>;
  po::options_description description(
      "Usage: map_bag BAG --output FOLDER [options]\n"
      "Maps the clouds of a bag as fast as it goes; needs no ROS master. Exit code 3: the results\n"
      "are written, but parts of the bag were damaged and left out.\nOptions");
  auto add = description.add_options();
  add("help,h", "print this text");
  add("bag", po::value<Text>(), "the bag (also without --bag, as the first argument)");
  add("output,o", po::value<Text>(),
      "folder for trajectory, map, configuration, timings and summary; made if need be");
  add("topic", po::value<Text>(), "of the clouds (default: the only one of the bag)");
  add("config", po::value<Text>(), "indoor, outdoor, terrestrial, or a YAML file");
  add("representation", po::value<Text>(), "sparse, all or random: what scans are aligned to");
  add("threads", po::value<Text>(), "results do not depend on it");
  add("set", po::value<Texts>()->composing()->multitoken(),
      "name=value ..., parameters of the configuration");
  add("reference", po::value<Text>(), "true trajectory of the same frame, TUM format");
  add("base-frame", po::value<Text>(), "frame whose trajectory is written (default: the clouds')");
  add("odom-frame", po::value<Text>(), "frame of a smooth odometry in /tf, for the prediction");
  add("stride", po::value<Text>(), "use every N-th cloud");
  add("skip", po::value<Texts>()->composing(), "A-B, leave out clouds A to B, counted from 0");
  add("occupied", "also write map_occupied.ply with all occupied voxels");
  return description;
}

po::variables_map parse(int argc, const char* const* argv, const po::options_description& known) {
  po::positional_options_description positional;
  positional.add("bag", 1);
  namespace style = po::command_line_style;
  po::variables_map given;
  po::store(po::command_line_parser(argc, argv)
                .options(known)
                .positional(positional)
                .style(style::unix_style & ~style::allow_guessing)
                .run(),
            given);
  return given;
}

std::string textOf(const po::variables_map& given, const char* name) {
  return given.count(name) > 0 ? given[name].as<std::string>() : std::string();
}

std::vector<std::string> textsOf(const po::variables_map& given, const char* name) {
  return given.count(name) > 0 ? given[name].as<std::vector<std::string>>()
                               : std::vector<std::string>();
}

size_t countOf(const std::string& text, const char* option) {
  const bool digits = !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isdigit(c) != 0;
  });
  if (digits && text.size() < 10) return std::stoul(text);
  throw UsageError(std::string("--") + option + " needs a whole number of up to 9 digits, not '" +
                   text + "'");
}

CloudRange rangeOf(const std::string& text) {
  const size_t dash = text.find('-');
  if (dash == std::string::npos) throw UsageError("--skip needs a range A-B, not '" + text + "'");
  const CloudRange range{countOf(text.substr(0, dash), "skip"),
                         countOf(text.substr(dash + 1), "skip")};
  if (range.first > range.last) throw UsageError("--skip " + text + ": the first is the larger");
  return range;
}

MapBagOptions optionsOf(const po::variables_map& given) {
  MapBagOptions options;
  options.bag = textOf(given, "bag");
  options.output = textOf(given, "output");
  options.topic = textOf(given, "topic");
  options.config = textOf(given, "config");
  options.reference = textOf(given, "reference");
  options.frames = {textOf(given, "base-frame"), textOf(given, "odom-frame")};
  options.write_occupied = given.count("occupied") > 0;
  if (given.count("stride") > 0) options.stride = countOf(textOf(given, "stride"), "stride");
  for (const std::string& text : textsOf(given, "skip")) options.skipped.push_back(rangeOf(text));
  for (const char* name : {"representation", "threads"}) {
    if (given.count(name) == 0) continue;
    const std::string parameter = std::string(name) == "threads" ? name : "map/representation";
    options.settings.push_back(parameter + "=" + textOf(given, name));
  }
  for (const std::string& text : textsOf(given, "set")) options.settings.push_back(text);
  if (options.bag.empty()) throw UsageError("name the bag to map: map_bag BAG --output FOLDER");
  if (options.output.empty()) throw UsageError("name a folder for the results: --output FOLDER");
  if (options.stride == 0) throw UsageError("--stride must be at least 1");
  return options;
}

}  // namespace

std::optional<MapBagOptions> parseMapBagOptions(int argc, const char* const* argv) {
  const po::options_description known = describe();
  try {
    const po::variables_map given = parse(argc, argv, known);
    if (given.count("help") == 0) return optionsOf(given);
  } catch (const po::error& error) {
    throw UsageError(std::string(error.what()) + "; see map_bag --help");
  }
  std::cout << known;
  return std::nullopt;
}

Config configOf(const MapBagOptions& options) {
  Config config;
  if (!options.config.empty()) applyConfigFile(findConfigFile(options.config), config);
  for (const std::string& setting : options.settings) applySetting(setting, config);
  validate(config);
  return config;
}

bool isUsed(size_t cloud, const MapBagOptions& options) {
  if (cloud % options.stride != 0) return false;
  return std::none_of(options.skipped.begin(), options.skipped.end(), [&](const CloudRange& range) {
    return cloud >= range.first && cloud <= range.last;
  });
}

}  // namespace edgevox
