// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#include "core/scan/scan_sample.hpp"
#include "edgevox/io/map_file.hpp"
#include "edgevox/map/map_builder.hpp"
#include "evaluation/scan_stream.hpp"
#include "evaluation/search_measures.hpp"
#include "evaluation/simulated_truth.hpp"
#include "evaluation/subjects.hpp"
#include "run/run_files.hpp"
#include "tools/config_file.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;

po::options_description describe() {
  po::options_description known = withHelp(
      "Usage: evaluate localize MAP INPUT --output FOLDER [options]\n"
      "Looks for each scan of a recording alone in a whole map, without a guess, and counts those\n"
      "that are found. Writes FOLDER/localize.md, localize.csv and localize.png and prints the\n"
      "first.\nOptions");
  auto add = known.add_options();
  add("map", po::value<std::string>()->required(),
      "a map file, in whose frame --poses are; of a simulated INPUT: whose run began with the "
      "first scan; or WORLD:SENSOR[:SEED], to be mapped at the true poses; the first argument");
  addRecordingOptions(known);
  add("level", "take the sensor as level; default: it is told where up is, as by an IMU");
  add("set", po::value<std::vector<std::string>>()->multitoken(),
      "name=value ..., parameters of the configuration");
  add("output,o", po::value<std::string>()->required(), "folder for the results; made if need be");
  return known;
}

/// A map in the frame of a simulated world, as its compact file holds it.
MapFile simulatedMap(const std::string& input, const Config& config) {
  MapBuilder builder(config.voxel_size, config.map, config.edges, config.threads,
                     config.voxelizer.max_range);
  Voxelizer voxelizer(config.voxelizer, config.voxel_size);
  simulatedStream(input)(
      std::numeric_limits<size_t>::max(), [&](const CloudView& cloud, const TruePose& truth) {
        const VoxelScan scan = voxelizer.voxelize(cloud);
        const double middle = sweepTime(scan).middle();
        builder.insert(placedCentroids(scan, truth), truth(middle).translation());
      });
  builder.label();
  return {mapFileBytes(builder.completeMap(), config, "map", builder.scans()), input};
}

/// The map's frame is that of the first scan, where each walk through a world begins.
Pose mapFromWorld(const std::string& input) {
  if (!isSimulated(input)) return Pose::Identity();
  return simulatedTruth(input).path.poseAt(0.0).inverse();
}

void apply(const std::vector<std::string>& settings, Config& config) {
  for (const std::string& setting : settings) applySetting(setting, config);
  validate(config);
}

MapFile mapOf(const std::string& source, const std::vector<std::string>& settings) {
  if (!isSimulated(source)) return MapFile::read(source);
  Config config;
  apply(settings, config);
  return simulatedMap(source, config);
}

SearchMeasureOptions measureOptionsOf(const po::variables_map& given, const MapFile& map) {
  const auto source = given["map"].as<std::string>();
  const std::vector<std::string> settings = textsOf(given, "set");
  SearchMeasureOptions options;
  options.map_name = fs::path(source).filename().string();
  options.level = given.count("level") > 0;
  options.config = map.config();
  apply(settings, options.config);
  map.requireSameMap(options.config);
  options.config_name = isSimulated(source) ? "the defaults" : "of the map";
  for (const std::string& setting : settings) options.config_name += " " + setting;
  if (!isSimulated(source)) {
    options.T_map_recording = mapFromWorld(given["input"].as<std::string>());
  }
  return options;
}

}  // namespace

void evaluateLocalize(const Arguments& arguments) {
  const auto given = parseOptions(arguments, describe(), std::vector<std::string>{"map", "input"});
  if (!given) return;
  const auto source = (*given)["map"].as<std::string>();
  const fs::path folder = (*given)["output"].as<std::string>();
  const Recording recording = makeRecording(recordingOptionsOf(*given));
  makeFolder(folder);
  std::cerr << "evaluate: map of " << source << "\n";
  const MapFile map = mapOf(source, textsOf(*given, "set"));
  const SearchMeasureOptions options = measureOptionsOf(*given, map);
  std::cerr << "evaluate: " << recording.scans.size() << " searches\n";
  const auto trials = measureSearch(map.matchMap(), recording, options);
  writeResults(folder, "localize", "plot_localize", searchTable(trials),
               searchMarkdown(recording, options, trials));
}

}  // namespace edgevox
