// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/scan/scan_sample.hpp"
#include "edgevox/io/map_file.hpp"
#include "edgevox/io/number_text.hpp"
#include "edgevox/map/map_builder.hpp"
#include "evaluation/scan_stream.hpp"
#include "evaluation/search_measures.hpp"
#include "evaluation/simulated_truth.hpp"
#include "evaluation/subjects.hpp"
#include "run/run_files.hpp"
#include "tools/config_file.hpp"

namespace edgevox {
namespace {

constexpr int kSightings = 3;  // of voxels added to a map

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
  add("remove", po::value<double>()->default_value(0.0),
      "share of the voxels of a simulated map that are left out of it");
  add("add", po::value<double>()->default_value(0.0),
      "the same, of voxels added to it, anywhere in its extent");
  add("pcl-every", po::value<size_t>()->default_value(0),
      "every so many scans, look also by FPFH, SAC-IA and ICP of PCL; 0: never");
  add("output,o", po::value<std::string>()->required(), "folder for the results; made if need be");
  return known;
}

/// What a map is made to differ by from the world it is of: shares of its voxels.
struct Change {
  double removed = 0.0;
  double added = 0.0;
};

Change changeOf(const po::variables_map& given) {
  const Change change{given["remove"].as<double>(), given["add"].as<double>()};
  for (const double share : {change.removed, change.added}) {
    if (!(share >= 0.0 && share < 1.0)) throw UsageError("--remove and --add take 0 up to 1");
  }
  if (change.removed + change.added > 0.0 && !isSimulated(given["map"].as<std::string>())) {
    throw UsageError("--remove and --add need a map of a simulated WORLD:SENSOR[:SEED]");
  }
  return change;
}

/// Leaves out the points in voxels chosen by chance, the same ones in each scan.
std::vector<Eigen::Vector3d> without(double share, double voxel_size,
                                     std::vector<Eigen::Vector3d> points) {
  const auto is_out = [&](const Eigen::Vector3d& point) {
    const VoxelIndex v = voxelAt(point, 1.0 / voxel_size);
    std::seed_seq seed{v.x, v.y, v.z};
    std::array<uint32_t, 1> draw{};
    seed.generate(draw.begin(), draw.end());
    return draw[0] < share * std::pow(2.0, 32);
  };
  points.erase(std::remove_if(points.begin(), points.end(), is_out), points.end());
  return points;
}

/// Adds voxels anywhere in the map's extent, seen as often as it takes.
void addAnywhere(double share, MapBuilder& builder) {
  if (share == 0.0) return;
  Eigen::AlignedBox3d extent;
  builder.hitVoxels().forEach(
      [&](const VoxelIndex& v) { extent.extend(voxelCentre(v, builder.voxelSize(0))); });
  std::mt19937 random(1);
  const auto drawn = [&](int axis) {
    return std::uniform_real_distribution<>(extent.min()[axis], extent.max()[axis])(random);
  };
  std::vector<Eigen::Vector3d> points;
  const auto count = static_cast<size_t>(share * static_cast<double>(builder.hitVoxelCount()));
  for (size_t i = 0; i < count; ++i) points.emplace_back(drawn(0), drawn(1), drawn(2));
  for (int scan = 0; scan < kSightings; ++scan) builder.add(points, extent.center());
}

/// A map in the frame of a simulated world, as its compact file holds it.
MapFile simulatedMap(const std::string& input, const Config& config, const Change& change) {
  MapBuilder builder(config.voxel_size, config.map, config.edges, config.threads,
                     config.voxelizer.max_range);
  Voxelizer voxelizer(config.voxelizer, config.voxel_size);
  simulatedStream(input)(
      std::numeric_limits<size_t>::max(), [&](const CloudView& cloud, const TruePose& truth) {
        const VoxelScan scan = voxelizer.voxelize(cloud);
        const double middle = sweepTime(scan).middle();
        builder.insert(without(change.removed, config.voxel_size, placedCentroids(scan, truth)),
                       truth(middle).translation());
      });
  addAnywhere(change.added, builder);
  builder.label();
  return {mapFileBytes(builder.completeMap(), config, "map", builder.scans()), input};
}

/// The map's frame is that of the first scan, where each walk through a world begins.
Pose mapFromWorld(const std::string& input) {
  if (!isSimulated(input)) return Pose::Identity();
  return simulatedTruth(input).path.poseAt(0.0).inverse();
}

void applyAll(const std::vector<std::string>& settings, Config& config) {
  for (const std::string& setting : settings) applySetting(setting, config);
  validate(config);
}

MapFile mapOf(const po::variables_map& given) {
  const auto source = given["map"].as<std::string>();
  const Change change = changeOf(given);
  if (!isSimulated(source)) return MapFile::read(source);
  Config config;
  applyAll(textsOf(given, "set"), config);
  return simulatedMap(source, config, change);
}

std::string percentText(double share) { return shortText(1e2 * share) + " % of its voxels"; }

SearchMeasureOptions measureOptionsOf(const po::variables_map& given, const MapFile& map) {
  const auto source = given["map"].as<std::string>();
  const std::vector<std::string> settings = textsOf(given, "set");
  SearchMeasureOptions options;
  options.map_name = fs::path(source).filename().string();
  const Change change = changeOf(given);
  if (change.removed > 0.0) options.map_name += " less " + percentText(change.removed);
  if (change.added > 0.0) options.map_name += " and " + percentText(change.added) + " more";
  options.level = given.count("level") > 0;
  options.pcl_every = given["pcl-every"].as<size_t>();
  options.config = map.config();
  applyAll(settings, options.config);
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
  const MapFile map = mapOf(*given);
  const SearchMeasureOptions options = measureOptionsOf(*given, map);
  std::cerr << "evaluate: " << recording.scans.size() << " searches\n";
  const auto methods = measureSearch(map.matchMap(), recording, options);
  writeResults(folder, "localize", "plot_localize", searchTable(methods),
               searchMarkdown(recording, options, methods));
}

}  // namespace edgevox
