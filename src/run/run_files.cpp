// SPDX-License-Identifier: BSD-3-Clause
#include "run/run_files.hpp"

#include <sys/resource.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "edgevox/io/atomic_file.hpp"
#include "edgevox/io/number_text.hpp"
#include "edgevox/statistics.hpp"
#include "run/map_files.hpp"
#include "run/run_folder.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;

constexpr double kMilliseconds = 1e3;  // in a second

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "";
  return fixedText(value, decimals);
}

/// Of the scans of which it is known.
template <typename Value>
std::vector<double> valuesOf(const Pool<ScanRecord>& scans, const Value& value) {
  std::vector<double> values;
  for (const ScanRecord& record : scans) {
    const auto known = static_cast<double>(value(record));
    if (std::isfinite(known)) values.push_back(known);
  }
  return values;
}

template <typename Seconds>
std::vector<double> milliseconds(const Pool<ScanRecord>& scans, const Seconds& seconds) {
  return valuesOf(scans, [&](const ScanRecord& record) {
    return kMilliseconds * static_cast<double>(seconds(record));
  });
}

/// [ms]
std::vector<double> latenciesOf(const Pool<ScanRecord>& scans) {
  std::vector<double> values;
  for (const ScanRecord& record : scans) {
    if (record.latency > 0) values.push_back(kMilliseconds * static_cast<double>(record.latency));
  }
  return values;
}

void addScans(const RunRecord& run, Report& report) {
  report.add("scans", uint64_t{run.scans.size()});
  report.add("tracked", uint64_t{run.located()});
  report.add("fallback", uint64_t{run.count(ScanStatus::kFallback)});
  report.add("lost", uint64_t{run.count(ScanStatus::kLost)});
  report.add("ambiguous", uint64_t{run.count(ScanStatus::kAmbiguous)});
  report.add("stale", uint64_t{run.count(ScanStatus::kStale)});
  report.add("too_few_voxels", uint64_t{run.count(ScanStatus::kTooFew)});
  report.add("too_large", uint64_t{run.count(ScanStatus::kTooLarge)});
  report.add("without_odometry", uint64_t{run.without_odometry});
  report.add("odometry_jumps", uint64_t{run.odometry_jumps});
  report.add("clock_jumps", uint64_t{run.clock_jumps});
  report.add("begun_anew", uint64_t{run.begun_anew});
  report.add("degenerate", uint64_t{run.degenerate});
  Report left_out;
  for (const auto& [reason, count] : run.left_out) left_out.add(reason, uint64_t{count});
  report.add("clouds_left_out", left_out);
  report.add("refused", run.refused);
  report.add("dropped", run.dropped);
}

/// Median over the scans.
double sparseShareOf(const Pool<ScanRecord>& scans) {
  return quantile(valuesOf(scans, [](const ScanRecord& r) { return r.sparse_share; }), 0.5);
}

void addPoints(const RunRecord& run, Report& report) {
  Report dropped;
  dropped.add("not_finite", run.dropped_points.not_finite);
  dropped.add("too_near", run.dropped_points.too_near);
  dropped.add("too_far", run.dropped_points.too_far);
  report.add("points", run.points);
  report.add("points_dropped", dropped);
  report.add("sparse_share", sparseShareOf(run.scans));
  report.add("time_field", run.time_field.empty() ? "none" : run.time_field);
  report.add("points_bad_time", run.dropped_points.bad_time);
}

void addTimes(const Pool<ScanRecord>& scans, Report& report) {
  const std::vector<double> totals = milliseconds(scans, [](const auto& r) { return r.total; });
  report.add("ms_mean", mean(totals));
  report.add("ms_p95", quantile(totals, 0.95));
  Report stages;
  for (const Stage& stage : kStages) {
    stages.add(stage.name,
               mean(milliseconds(scans, [&](const auto& r) { return r.times.*stage.time; })));
  }
  report.add("ms_stages", stages);
  const std::vector<double> latencies = latenciesOf(scans);
  if (latencies.empty()) return;
  report.add("latency_ms_median", quantile(latencies, 0.5));
  report.add("latency_ms_p95", quantile(latencies, 0.95));
}

double peakMegabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void addMap(const MapBuilder& map, size_t map_bytes, Report& report) {
  const uint64_t occupied = map.hitVoxelCount();
  const uint64_t edges = map.edgeVoxels().voxelCount();
  report.add("occupied_voxels", occupied);
  report.add("edge_voxels", edges);
  report.add("compression", static_cast<double>(occupied) / static_cast<double>(edges));
  report.add("cleared_voxels", uint64_t{map.clearedVoxels()});
  report.add("frozen_regions", uint64_t{map.frozenRegions()});
  report.add("frozen_voxels", uint64_t{map.frozenVoxels()});
  report.add("thawed_regions", uint64_t{map.thawedRegions()});
  report.add("lone_centroids", uint64_t{map.loneCentroids()});
  report.add("centroids_past_memory", uint64_t{map.centroidsPastMemory()});
  report.add("map_bytes", uint64_t{map_bytes});
  report.add("map_bytes_working", uint64_t{map.bytes()});
}

/// What becomes map.edgevox.
struct MapFiles {
  std::string content;
  size_t compact_bytes = 0;
};

/// A full one is taken before the labels are brought up to date, which mapping on would not do.
MapFiles mapFilesOf(const RunResults& results) {
  MapFiles files;
  if (results.mapper == nullptr) return files;
  const auto bytesOf = [&](MapContent content) {
    return mapFileBytes(content, *results.mapper, results.config, results.map_frame);
  };
  const bool full = results.content == MapContent::kFull;
  if (full) files.content = bytesOf(MapContent::kFull);
  results.mapper->finishLabels();
  std::string compact = bytesOf(MapContent::kCompact);
  files.compact_bytes = compact.size();
  if (!full) files.content = std::move(compact);
  return files;
}

}  // namespace

std::string timingsCsv(const Pool<ScanRecord>& scans) {
  std::string text = "scan,stamp,status,hit_ratio,points,voxels";
  for (const Stage& stage : kStages) text += std::string(",") + stage.name + "_ms";
  text += ",total_ms,latency_ms\n";
  const auto ms = [](float seconds) {
    return fixed(kMilliseconds * static_cast<double>(seconds), 3);
  };
  for (const ScanRecord& record : scans) {
    text += std::to_string(record.cloud) + "," + fixed(record.stamp, 6) + "," +
            toString(record.status) + "," + fixed(static_cast<double>(record.hit_ratio), 4) + "," +
            std::to_string(record.points) + "," + std::to_string(record.voxels);
    for (const Stage& stage : kStages) text += "," + ms(record.times.*stage.time);
    text += "," + ms(record.total) + "," + (record.latency > 0 ? ms(record.latency) : "") + "\n";
  }
  return text;
}

std::string errorsCsv(const TrajectoryErrors& errors) {
  std::string text = "stamp,ape_m,rpe_m,rpe_deg,moving\n";
  for (const PoseError& pose : errors.poses) {
    text += fixed(pose.stamp, 6) + "," + fixed(pose.ape_m, 6) + "," + fixed(pose.rpe_m, 6) + "," +
            fixed(pose.rpe_deg, 6) + "," + (pose.moving ? "1" : "0") + "\n";
  }
  return text;
}

Report errorsReport(const TrajectoryErrors& errors) {
  Report report;
  report.add("reference_poses", uint64_t{errors.poses.size()});
  report.add("ape_rmse_m", errors.ape_rmse_m);
  report.add("ape_rmse_deg", errors.ape_rmse_deg);
  for (const auto& [prefix, rpe] : {std::make_pair(std::string(), errors.moving),
                                    std::make_pair(std::string("standing_"), errors.standing)}) {
    report.add(prefix.empty() ? "moving_pairs" : "standing_pairs", uint64_t{rpe.pairs});
    report.add(prefix + "rpe_median_m", rpe.median_m);
    report.add(prefix + "rpe_p95_m", rpe.p95_m);
    report.add(prefix + "rpe_median_deg", rpe.median_deg);
    report.add(prefix + "rpe_p95_deg", rpe.p95_deg);
  }
  return report;
}

Report summarise(const RunRecord& run, const MapBuilder* map, const RunSize& size,
                 const std::optional<TrajectoryErrors>& errors) {
  Report report;
  addScans(run, report);
  addTimes(run.scans, report);
  if (map != nullptr) addMap(*map, size.map_bytes, report);
  report.add("peak_rss_mb", size.peak_rss_mb);
  if (errors) report.append(errorsReport(*errors));
  addPoints(run, report);
  return report;
}

void makeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) return;
  throw FileError("cannot make the folder '" + folder.string() + "': " + error.message() +
                  "; choose another output folder");
}

Report writeRun(const fs::path& folder, const RunResults& results) {
  const MapBuilder* map = results.mapper == nullptr ? nullptr : &results.mapper->map();
  if (map != nullptr ? map->empty() : results.run.located() == 0) {
    throw FileError(std::string(map != nullptr ? "the map is empty" : "no scan was located") +
                    ": nothing is saved, and what is in '" + folder.string() + "' stays as it is");
  }
  const double peak_rss_mb = peakMegabytes();
  const MapFiles maps = mapFilesOf(results);
  const Report summary =
      summarise(results.run, map, {maps.compact_bytes, peak_rss_mb}, results.errors);
  makeFolder(folder);
  RunFolder files(folder);
  writeFile(files.stage("config.yaml"), yamlText(results.config));
  writeTum(files.stage("trajectory.tum"), results.run.trajectory());
  if (map != nullptr) {
    const auto edges = centroidsOf(*map, map->edgeVoxels());
    writePly(files.stage("map_edges.ply"), edges);
    writePcd(files.stage("map_edges.pcd"), edges);
    writeFile(files.stage("map.edgevox"), maps.content);
  }
  if (map != nullptr && results.occupied_too) {
    writePly(files.stage("map_occupied.ply"), centroidsOf(*map, map->hitVoxels()));
  }
  writeFile(files.stage("timings.csv"), timingsCsv(results.run.scans));
  if (results.errors) writeFile(files.stage("errors.csv"), errorsCsv(*results.errors));
  writeFile(files.stage("summary.json"), summary.json());
  files.replace();
  return summary;
}

}  // namespace edgevox
