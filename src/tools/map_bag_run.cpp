// SPDX-License-Identifier: BSD-3-Clause
#include "tools/map_bag_run.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>

#include "edgevox/io/atomic_file.hpp"
#include "edgevox/io/trajectory_evaluation.hpp"
#include "run/run_files.hpp"
#include "tools/bag_reader.hpp"
#include "tools/cloud_mapping.hpp"
#include "tools/config_file.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;

constexpr ScanStatus kNotLocated[] = {ScanStatus::kLost, ScanStatus::kAmbiguous, ScanStatus::kStale,
                                      ScanStatus::kTooFew, ScanStatus::kTooLarge};
constexpr double kTransformCache = 30.0 * 24 * 3600;  // [s], longer than any bag

/// Fails now and not after the mapping.
void requireWritable(const fs::path& folder) {
  makeFolder(folder);
  const AtomicFile probe(folder / "trajectory.tum");
}

/// The files of a run replace those of the one before: the map's among them.
void requireOtherFolder(const MapBagOptions& options) {
  if (options.localize.empty()) return;
  const fs::path folder = fs::weakly_canonical(fs::path(options.localize)).parent_path();
  if (folder != fs::weakly_canonical(options.output)) return;
  throw UsageError("the map '" + options.localize + "' lies in the output folder, whose files " +
                   "will be replaced: choose another --output");
}

void readTransforms(BagReader& bag, CheckedTransforms& transforms, Console& console) {
  for (const auto& [reason, refused] : bag.readTransforms(transforms)) {
    console.print(refused.first + ". Of this kind: " + std::to_string(refused.count) + ".");
  }
}

std::string countsOf(const CloudMapping& mapping) {
  std::string counts;
  const auto add = [&](const std::string& reason, size_t count) {
    if (count > 0) counts += (counts.empty() ? "" : ", ") + reason + " " + std::to_string(count);
  };
  for (const auto& [reason, count] : mapping.run().left_out) add(reason, count);
  for (const ScanStatus status : kNotLocated) add(toString(status), mapping.run().count(status));
  return counts;
}

void requireScans(const BagReader& bag, const CloudMapping& mapping) {
  if (mapping.run().located() > 0) return;
  const std::string counts = countsOf(mapping);
  throw BagError("none of the " + std::to_string(bag.cloudCount()) + " clouds on topic '" +
                 bag.topic() + "' could be used (" +
                 (counts.empty() ? "see --skip and --stride" : counts) + ")");
}

void mapClouds(BagReader& bag, const MapBagOptions& options, Console& console,
               CloudMapping& mapping) {
  bag.forEachCloud([&](size_t cloud, const BagReader::ReadCloud& read) {
    if (isUsed(cloud, options)) mapping.add(cloud, read());
    console.showProgress(cloud + 1, bag.cloudCount());
  });
  for (const std::string& text : textsOf(bag.losses())) console.print(text);
  requireScans(bag, mapping);
  if (const auto warning = mapping.densityMonitor().warning()) console.print(textOf(*warning));
  if (mapping.map().isFull()) console.print(fullText(mapping.config().map));
}

/// Of the clouds that were used, if half of them or more were not located.
std::string warningOf(const CloudMapping& mapping) {
  const RunRecord& run = mapping.run();
  if (2 * run.located() > run.scans.size()) return "";
  const auto* commonest =
      std::max_element(std::begin(kNotLocated), std::end(kNotLocated),
                       [&](ScanStatus a, ScanStatus b) { return run.count(a) < run.count(b); });
  return "only " + std::to_string(run.located()) + " of " + std::to_string(run.scans.size()) +
         " clouds were located (" + countsOf(mapping) + "); of the first that is " +
         toString(*commonest) + ": " + mapping.adviceOn(*commonest);
}

/// Why there are no errors; empty if there are.
std::string evaluateRun(const MapBagOptions& options, const Trajectory& reference,
                        RunResults& results) {
  try {
    results.errors = evaluate(results.run.trajectory(), reference);
    return "";
  } catch (const TrajectoryError& error) {
    return "the results in '" + options.output.string() + "' are without errors: " + error.what();
  }
}

std::string lossOf(const BagReader& bag, const MapBagOptions& options) {
  if (bag.losses().empty()) return "";
  size_t clouds = 0;
  size_t transforms = 0;
  for (const auto& [chunk, loss] : bag.losses()) {
    clouds += loss.clouds.size();
    transforms += loss.transforms;
  }
  return "bag '" + options.bag + "' is damaged, see above: the results in '" +
         options.output.string() + "' are without " + std::to_string(clouds) + " of " +
         std::to_string(bag.cloudCount()) + " clouds and " + std::to_string(transforms) +
         " messages of transforms";
}

}  // namespace

MapBagOutcome runMapBag(const MapBagOptions& options, Console& console) {
  requireOtherFolder(options);
  const std::string map_file = options.map.empty() ? options.localize : options.map;
  std::optional<MapFile> map;
  if (!map_file.empty()) map = MapFile::read(map_file);
  const Config config = configOf(options, map ? map->config() : Config());
  if (map) map->requireSameMap(config);
  std::optional<Trajectory> reference;
  if (!options.reference.empty()) reference = readTum(options.reference);
  BagReader bag(options.bag, options.topic);
  requireWritable(options.output);

  CheckedTransforms transforms(ros::Duration(kTransformCache), config.mapper.clock_leap);
  readTransforms(bag, transforms, console);
  CloudMapping mapping(config, SensorFrames(transforms.buffer(), options.frames), console);
  if (!options.map.empty()) map->restore(mapping.pipeline().mapper());
  if (!options.localize.empty()) mapping.pipeline().localizeIn(map->matchMap(), options.start);
  map.reset();
  mapClouds(bag, options, console, mapping);

  RunResults results{config, mapping.run()};
  if (options.localize.empty()) results.mapper = &mapping.pipeline().mapper();
  results.content = options.full ? MapContent::kFull : MapContent::kCompact;
  results.occupied_too = options.write_occupied;
  std::string loss = lossOf(bag, options);
  if (reference) {
    const std::string without = evaluateRun(options, *reference, results);
    loss += (loss.empty() || without.empty() ? "" : "; ") + without;
  }
  const Report summary = writeRun(options.output, results);
  return {summary, loss, warningOf(mapping)};
}

}  // namespace edgevox
