// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/map_measures.hpp"

#include <optional>

#include "core/scan/scan_sample.hpp"
#include "edgevox/io/map_file.hpp"
#include "edgevox/io/number_text.hpp"
#include "edgevox/io/trajectory_evaluation.hpp"
#include "edgevox/mapping/pipeline.hpp"
#include "edgevox/matching/free_space.hpp"
#include "edgevox/statistics.hpp"
#include "edgevox/tracking/acceptance.hpp"
#include "evaluation/capture.hpp"
#include "evaluation/placed_scan.hpp"
#include "evaluation/share.hpp"

namespace edgevox {
namespace {

const char* nameOf(Representation representation) {
  switch (representation) {
    case Representation::kSparse:
      return "sparse";
    case Representation::kAll:
      return "all";
    case Representation::kRandom:
      return "random";
    case Representation::kEdges:
      return "edges";
  }
  return "";
}

/// One way through the recording.
struct Run {
  std::vector<std::optional<Pose>> poses;  ///< T_map_sensor of each scan; none: not located
  Trajectory trajectory;
  std::vector<double> milliseconds;  ///< CPU time of a scan
  size_t lost = 0;
  size_t fallback = 0;
};

Run runThrough(const Recording& recording, Pipeline& pipeline) {
  Run run;
  for (const RecordedScan& recorded : recording.scans) {
    const ScanResult scan = pipeline.process(recorded.view).scan;
    run.milliseconds.push_back(1e3 * static_cast<double>(scan.times.total()));
    run.fallback += scan.status == ScanStatus::kFallback ? 1 : 0;
    run.lost += scan.located() ? 0 : 1;
    run.poses.push_back(scan.located() ? std::optional<Pose>(scan.T_map_sensor) : std::nullopt);
    if (scan.located()) run.trajectory.push_back({scan.stamp, scan.T_map_sensor});
  }
  pipeline.mapper().finishLabels();
  return run;
}

Trajectory referenceOf(const Recording& recording) {
  Trajectory reference;
  for (const RecordedScan& scan : recording.scans) {
    reference.push_back({scan.view.stamp, scan.T_map_sensor});
  }
  return reference;
}

/// The matcher, with restarts, verified as while mapping: by what is usual at the true pose.
Registration matcherRegistration(const MatchMap& map, const CaptureProbe& probe,
                                 const MatcherConfig& config) {
  const Matcher matcher(config);
  const ScanSample sample = sampleCentroids(probe.scan, matcher.sampleSize());
  const double usual =
      Matcher::hits(map, sample, matcher.refinePoints(sample), probe.T_map_sensor).ratio;
  Acceptance acceptance(config, MapperConfig{});
  acceptance.addHitRatio(usual);
  acceptance.addBlocked(blockedShare(map, sample, kLinesOfSight, probe.T_map_sensor));
  MatchRequest request;
  acceptance.setLimits(0, false, request);
  return [=, &map](const Pose& guess, uint64_t seed) -> CapturedPose {
    MatchRequest from_guess = request;
    from_guess.guess.T_map_sensor = guess;
    from_guess.seed = seed;
    const MatchResult match = matcher.match(map, sample, from_guess);
    return {match.T_map_sensor, match.accepted()};
  };
}

/// The share of wrong guesses of the poses of a run from which they are found again.
double capturedShare(const Recording& recording, const MapMeasureOptions& options,
                     const Config& config, const MapBuilder& map, const Run& run) {
  Voxelizer voxelizer(config.voxelizer, config.voxel_size);
  const Disturbance disturbance = disturbedBy(options.capture_distance, options.capture_angle);
  CaptureCounts counts;
  for (size_t i = 0; i < options.capture_scans; ++i) {
    const size_t scan = i * run.poses.size() / options.capture_scans;
    if (!run.poses[scan]) continue;
    const auto truth = [&](double time_offset) { return recording.poseAt(scan, time_offset); };
    const CaptureProbe probe{seenAtOnce(voxelizer.voxelize(recording.scans[scan].view), truth),
                             *run.poses[scan], scan};
    counts += capture(probe, disturbance, options.capture_trials,
                      matcherRegistration(map.matchMap(), probe, config.matcher));
  }
  return shareOf(counts.right, counts.trials());
}

/// All rows of the table; the first is that of all voxels, which the others are compared with.
class MapTable {
 public:
  MapTable(const Recording& recording, const MapMeasureOptions& options)
      : recording_(recording), options_(options), reference_(referenceOf(recording)) {}

  void add(Representation representation, int anchors) {
    Config config = options_.config;
    config.map.representation = representation;
    config.map.anchors = anchors;
    Pipeline pipeline(config);
    const Run run = runThrough(recording_, pipeline);
    table_.addRow();
    table_.set("map", nameOf(representation));
    if (representation != Representation::kAll) table_.set("anchors", anchors);
    addSize(pipeline.mapper(), config);
    addErrors(run);
    table_.set("captured", capturedShare(recording_, options_, config, pipeline.map(), run));
    table_.set("ms", mean(run.milliseconds));
  }

  const Table& table() const { return table_; }

 private:
  void addSize(const Mapper& mapper, const Config& config) {
    const MapBuilder& map = mapper.map();
    const auto bytes =
        static_cast<double>(mapFileBytes(MapContent::kCompact, mapper, config, "map").size());
    if (table_.rows() == 1) all_bytes_ = bytes;
    table_.set("map_mb", bytes / 1e6);
    table_.set("smaller", all_bytes_ / bytes);
    table_.set("compression", static_cast<double>(map.hitVoxelCount()) /
                                  static_cast<double>(map.edgeVoxels().voxelCount()));
  }

  void addErrors(const Run& run) {
    table_.set("lost", static_cast<double>(run.lost));
    table_.set("fallback", static_cast<double>(run.fallback));
    const TrajectoryErrors errors = evaluate(run.trajectory, reference_);
    const double rpe = errors.moving.median_m;
    if (table_.rows() == 1) all_rpe_ = rpe;
    table_.set("rpe_mm", 1e3 * rpe);
    table_.set("rpe_ratio", rpe / all_rpe_);
    table_.set("rpe_p95_mm", 1e3 * errors.moving.p95_m);
    table_.set("rpe_deg", errors.moving.median_deg);
    table_.set("ape_cm", 1e2 * errors.ape_rmse_m);
  }

  const Recording& recording_;
  const MapMeasureOptions& options_;
  Trajectory reference_;
  double all_bytes_ = 0.0;
  double all_rpe_ = 0.0;
  Table table_{{{"map", "map", 0},
                {"anchors", "anchors", 0},
                {"map_mb", "MB", 2},
                {"smaller", "times smaller", 1},
                {"compression", "occupied / edges", 2},
                {"rpe_mm", "relative error [mm]", 2},
                {"rpe_ratio", "of that of all", 2},
                {"rpe_p95_mm", "95 % [mm]", 1},
                {"rpe_deg", "relative error [degrees]", 3},
                {"ape_cm", "absolute error [cm]", 2},
                {"lost", "lost", 0},
                {"fallback", "fallback", 0},
                {"captured", "captured", 3},
                {"ms", "ms a scan", 1}}};
};

}  // namespace

Table measureMaps(const Recording& recording, const MapMeasureOptions& options,
                  const std::function<void(const std::string&)>& note) {
  MapTable table(recording, options);
  note("all voxels");
  table.add(Representation::kAll, options.config.map.anchors);
  for (const int anchors : options.anchors) {
    note(std::to_string(anchors) + " anchors, and as many voxels by chance");
    table.add(Representation::kSparse, anchors);
    table.add(Representation::kRandom, anchors);
  }
  return table.table();
}

std::string mapMarkdown(const Recording& recording, const MapMeasureOptions& options,
                        const Table& table) {
  const std::string guess = shortText(options.capture_distance) + " m and " +
                            shortText(options.capture_angle) + " degrees";
  return "# Maps of " + recording.name + "\n\n" + std::to_string(recording.scans.size()) +
         " scans, reference poses " + recording.source + ", configuration " + options.config_name +
         ".\n\n" +
         table.markdown(
             {"map", "anchors", "map_mb", "smaller", "compression", "rpe_mm", "rpe_ratio",
              "rpe_p95_mm", "rpe_deg", "ape_cm", "lost", "fallback", "captured", "ms"},
             2) +
         "\nEach row is a run of its own through all scans. Scans are aligned to planes and, where "
         "they lie in none, to all occupied voxels of the map; to those that hold edges and "
         "`map/anchors` flat ones of each direction in a block; or to as many by chance. MB: of "
         "the compact file. Relative error: median and 95 % of the steps in which the sensor "
         "moves. Captured: of " +
         std::to_string(options.capture_scans * options.capture_trials) + " guesses, " + guess +
         " off in any direction, those from which the pose is found to 0.1 m and 1 degree on the "
         "finished map, with restarts.\n";
}

}  // namespace edgevox
