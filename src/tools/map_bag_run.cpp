// SPDX-License-Identifier: BSD-3-Clause
#include "tools/map_bag_run.hpp"

#include <array>
#include <optional>

#include "edgevox/atomic_file.hpp"
#include "edgevox/trajectory_evaluation.hpp"
#include "run/run_files.hpp"
#include "tools/bag_reader.hpp"
#include "tools/cloud_mapping.hpp"
#include "tools/config_file.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;

constexpr double kTransformCache = 30.0 * 24 * 3600;  // [s], longer than any bag
constexpr std::array<const char*, 7> kResults = {
    "trajectory.tum", "map_edges.ply", "map_edges.pcd", "map_occupied.ply",
    "timings.csv",    "errors.csv",    "summary.json"};

/// Also takes out of it what an earlier run has left: this one may fail, or write fewer files.
void prepareFolder(const fs::path& folder, const Config& config) {
  makeFolder(folder);
  std::error_code error;
  for (const char* file : kResults) fs::remove(folder / file, error);
  writeFile(folder / "config.yaml", yamlText(config));
}

void readTransforms(BagReader& bag, CheckedTransforms& transforms, Console& console) {
  for (const auto& [reason, refused] : bag.readTransforms(transforms)) {
    console.print(refused.first + ". Of this kind: " + std::to_string(refused.count) + ".");
  }
}

void requireScans(const BagReader& bag, const CloudMapping& mapping) {
  if (!mapping.run().scans.empty()) return;
  std::string reasons;
  for (const auto& [reason, count] : mapping.run().left_out) {
    reasons += (reasons.empty() ? "" : ", ") + reason + " " + std::to_string(count);
  }
  throw BagError("none of the " + std::to_string(bag.cloudCount()) + " clouds on topic '" +
                 bag.topic() + "' could be used (" +
                 (reasons.empty() ? "see --skip and --stride" : reasons) + ")");
}

void mapClouds(BagReader& bag, const MapBagOptions& options, Console& console,
               CloudMapping& mapping) {
  bag.forEachCloud([&](size_t cloud, const rosbag::MessageInstance& message) {
    if (isUsed(cloud, options)) mapping.add(cloud, BagReader::decode(message));
    console.showProgress(cloud + 1, bag.cloudCount());
  });
  requireScans(bag, mapping);
  mapping.finish();
  if (const auto warning = mapping.sparseAlarm().warning()) console.print(textOf(*warning));
}

}  // namespace

Report runMapBag(const MapBagOptions& options, Console& console) {
  const Config config = configOf(options);
  std::optional<Trajectory> reference;
  if (!options.reference.empty()) reference = readTum(options.reference);
  BagReader bag(options.bag, options.topic);
  prepareFolder(options.output, config);

  CheckedTransforms transforms(ros::Duration(kTransformCache), config.mapper.clock_leap);
  readTransforms(bag, transforms, console);
  CloudMapping mapping(config, SensorFrames(transforms.buffer(), options.frames), console);
  mapClouds(bag, options, console, mapping);

  const RunRecord& run = mapping.run();
  writeTum(options.output / "trajectory.tum", run.trajectory());
  writeMap(options.output, mapping.map(), options.write_occupied);
  writeFile(options.output / "timings.csv", timingsCsv(run.scans));
  std::optional<TrajectoryErrors> errors;
  if (reference) {
    errors = evaluate(run.trajectory(), *reference);
    writeFile(options.output / "errors.csv", errorsCsv(*errors));
  }
  const Report summary = summarise(run, mapping.map(), errors);
  writeFile(options.output / "summary.json", summary.json());
  return summary;
}

}  // namespace edgevox
