// SPDX-License-Identifier: BSD-3-Clause
#include "tools/map_bag_options.hpp"

#include <algorithm>
#include <cctype>

#include "edgevox/io/pose_text.hpp"
#include "tools/config_file.hpp"

namespace edgevox {
namespace {

namespace po = boost::program_options;

po::options_description describe() {
  using Text = std::string;
  using Texts = std::vector<std::string>;
  po::options_description description = withHelp(
      "Usage: map_bag BAG --output FOLDER [options]\n"
      "Maps the clouds of a bag as fast as it goes; needs no ROS master. Exit code 3: the results\n"
      "are written, but parts of the bag were damaged and left out.\nOptions");
  auto add = description.add_options();
  add("bag", po::value<Text>(), "the bag (also without --bag, as the first argument)");
  add("output,o", po::value<Text>(),
      "folder for trajectory, map, configuration, timings and summary; made if need be");
  add("topic", po::value<Text>(), "of the clouds (default: the only one of the bag)");
  add("config", po::value<Text>(), "indoor, outdoor, terrestrial, paper, or a YAML file");
  add("representation", po::value<Text>(),
      "sparse, all, random or edges: what scans are aligned to");
  add("threads", po::value<Text>(), "results do not depend on it");
  add("set", po::value<Texts>()->composing()->multitoken(),
      "name=value ..., parameters of the configuration");
  add("reference", po::value<Text>(), "true trajectory of the same frame, TUM format");
  add("base-frame", po::value<Text>(), "frame whose trajectory is written (default: the clouds')");
  add("odom-frame", po::value<Text>(), "frame of a smooth odometry in /tf, for the prediction");
  add("stride", po::value<int64_t>()->default_value(1), "use every N-th cloud");
  add("skip", po::value<Texts>()->composing(), "A-B, leave out clouds A to B, counted from 0");
  add("map", po::value<Text>(), "a full map file: mapping goes on where it was saved");
  add("localize", po::value<Text>(),
      "a map file: the clouds are located in it, it stays as it is, and no map is written");
  add("start", po::value<Text>(),
      "x,y,z,yaw [m, degrees], with --localize: about where the sensor is in the map at first "
      "(default: it is looked for everywhere)");
  add("full", "save map.edgevox with all that mapping needs to go on (see --map)");
  add("occupied", "also write map_occupied.ply with all occupied voxels");
  return description;
}

size_t cloudOf(const std::string& text) {
  const bool digits = !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isdigit(c) != 0;
  });
  if (digits && text.size() < 10) return std::stoul(text);
  throw UsageError("--skip needs whole numbers of up to 9 digits, not '" + text + "'");
}

CloudRange rangeOf(const std::string& text) {
  const size_t dash = text.find('-');
  if (dash == std::string::npos) throw UsageError("--skip needs a range A-B, not '" + text + "'");
  const CloudRange range{cloudOf(text.substr(0, dash)), cloudOf(text.substr(dash + 1))};
  if (range.first > range.last) throw UsageError("--skip " + text + ": the first is the larger");
  return range;
}

Pose startOf(const std::string& text) {
  if (const auto pose = poseOfText(text)) return *pose;
  throw UsageError("--start needs x,y,z,yaw, not '" + text + "'");
}

MapBagOptions optionsOf(const po::variables_map& given) {
  MapBagOptions options;
  options.bag = textOf(given, "bag");
  options.output = textOf(given, "output");
  options.topic = textOf(given, "topic");
  options.config = textOf(given, "config");
  options.reference = textOf(given, "reference");
  options.frames = {textOf(given, "base-frame"), textOf(given, "odom-frame")};
  options.map = textOf(given, "map");
  options.localize = textOf(given, "localize");
  if (given.count("start") > 0) options.start = startOf(textOf(given, "start"));
  options.full = given.count("full") > 0;
  options.write_occupied = given.count("occupied") > 0;
  options.stride = countOf(given, "stride", 1);
  for (const std::string& text : textsOf(given, "skip")) options.skipped.push_back(rangeOf(text));
  for (const char* name : {"representation", "threads"}) {
    if (given.count(name) == 0) continue;
    const std::string parameter = std::string(name) == "threads" ? name : "map/representation";
    options.settings.push_back(parameter + "=" + textOf(given, name));
  }
  for (const std::string& text : textsOf(given, "set")) options.settings.push_back(text);
  if (options.bag.empty()) throw UsageError("name the bag to map: map_bag BAG --output FOLDER");
  if (!options.map.empty() && !options.localize.empty()) {
    throw UsageError("--map goes on with a map, --localize leaves it as it is: choose one");
  }
  if (options.start && options.localize.empty()) {
    throw UsageError("--start tells where to look in the map of --localize");
  }
  if (options.output.empty()) throw UsageError("name a folder for the results: --output FOLDER");
  return options;
}

}  // namespace

std::optional<MapBagOptions> parseMapBagOptions(const Arguments& arguments) {
  const auto given = parseOptions(arguments, describe(), "bag");
  if (!given) return std::nullopt;
  return optionsOf(*given);
}

Config configOf(const MapBagOptions& options, const Config& defaults) {
  Config config = defaults;
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
