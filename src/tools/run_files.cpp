// SPDX-License-Identifier: BSD-3-Clause
#include "tools/run_files.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "edgevox/statistics.hpp"

namespace edgevox {
namespace {

constexpr double kMilliseconds = 1e3;  // in a second

struct Stage {
  const char* name;
  double (*seconds)(const ScanRecord&);
};

constexpr std::array<Stage, 5> kStages = {{
    {"voxelize", [](const ScanRecord& r) { return r.result.voxelize; }},
    {"extract", [](const ScanRecord& r) { return r.result.extract; }},
    {"match", [](const ScanRecord& r) { return r.result.scan.times.match; }},
    {"insert", [](const ScanRecord& r) { return r.result.scan.times.insert; }},
    {"label", [](const ScanRecord& r) { return r.result.scan.times.label; }},
}};

double totalOf(const ScanRecord& record) { return record.total; }

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "";
  std::array<char, 400> text;
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

std::vector<double> milliseconds(const std::vector<ScanRecord>& scans,
                                 double (*seconds)(const ScanRecord&)) {
  std::vector<double> values(scans.size());
  std::transform(scans.begin(), scans.end(), values.begin(),
                 [&](const ScanRecord& record) { return kMilliseconds * seconds(record); });
  return values;
}

template <typename Predicate>
uint64_t countIf(const std::vector<ScanRecord>& scans, const Predicate& holds) {
  return static_cast<uint64_t>(
      std::count_if(scans.begin(), scans.end(),
                    [&](const ScanRecord& record) { return holds(record.result.scan); }));
}

uint64_t countStatus(const std::vector<ScanRecord>& scans, ScanStatus status) {
  return countIf(scans, [&](const ScanResult& scan) { return scan.status == status; });
}

void addScans(const CloudMapping& mapping, Report& report) {
  const std::vector<ScanRecord>& scans = mapping.scans();
  report.add("scans", uint64_t{scans.size()});
  report.add("tracked", countIf(scans, [](const ScanResult& scan) { return scan.located(); }));
  report.add("fallback", countStatus(scans, ScanStatus::kFallback));
  report.add("lost", countStatus(scans, ScanStatus::kLost));
  report.add("stale", countStatus(scans, ScanStatus::kStale));
  report.add("too_few_voxels", countStatus(scans, ScanStatus::kTooFew));
  report.add("without_odometry", uint64_t{mapping.scansWithoutOdometry()});
  Report left_out;
  for (const auto& [reason, count] : mapping.cloudsLeftOut()) left_out.add(reason, uint64_t{count});
  report.add("clouds_left_out", left_out);
}

void addPoints(const CloudMapping& mapping, Report& report) {
  uint64_t points = 0;
  DroppedPoints sum;
  for (const ScanRecord& record : mapping.scans()) {
    points += record.result.points;
    sum.not_finite += record.result.dropped.not_finite;
    sum.too_near += record.result.dropped.too_near;
    sum.too_far += record.result.dropped.too_far;
    sum.bad_time += record.result.dropped.bad_time;
  }
  Report dropped;
  dropped.add("not_finite", sum.not_finite);
  dropped.add("too_near", sum.too_near);
  dropped.add("too_far", sum.too_far);
  report.add("points", points);
  report.add("points_dropped", dropped);
  report.add("time_field", mapping.timeField().empty() ? "none" : mapping.timeField());
  report.add("point_times_ignored", sum.bad_time);
}

void addTimes(const std::vector<ScanRecord>& scans, Report& report) {
  const std::vector<double> totals = milliseconds(scans, totalOf);
  report.add("ms_mean", mean(totals));
  report.add("ms_p95", quantile(totals, 0.95));
  Report stages;
  for (const Stage& stage : kStages)
    stages.add(stage.name, mean(milliseconds(scans, stage.seconds)));
  report.add("ms_stages", stages);
}

double peakMegabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void addMap(const OccupiedVoxelMap& map, Report& report) {
  const uint64_t occupied = map.hitVoxels().voxelCount();
  const uint64_t edges = map.edgeVoxels().voxelCount();
  report.add("occupied_voxels", occupied);
  report.add("edge_voxels", edges);
  report.add("compression", static_cast<double>(occupied) / static_cast<double>(edges));
  report.add("map_bytes", uint64_t{map.packedBytes()});
  report.add("map_bytes_working", uint64_t{map.bytes()});
  report.add("peak_rss_mb", peakMegabytes());
}

void addErrors(const TrajectoryErrors& errors, Report& report) {
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
}

}  // namespace

std::string timingsCsv(const std::vector<ScanRecord>& scans) {
  std::string text = "scan,stamp,status,hit_ratio,points,voxels";
  for (const Stage& stage : kStages) text += std::string(",") + stage.name + "_ms";
  text += ",total_ms\n";
  for (const ScanRecord& record : scans) {
    const ScanResult& scan = record.result.scan;
    text += std::to_string(record.cloud) + "," + fixed(scan.stamp, 6) + "," + name(scan.status) +
            "," + fixed(scan.hit_ratio, 4) + "," + std::to_string(record.result.points) + "," +
            std::to_string(record.result.scan_voxels);
    for (const Stage& stage : kStages) {
      text += "," + fixed(kMilliseconds * stage.seconds(record), 3);
    }
    text += "," + fixed(kMilliseconds * record.total, 3) + "\n";
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

Report summarise(const CloudMapping& mapping, const std::optional<TrajectoryErrors>& errors) {
  Report report;
  addScans(mapping, report);
  addTimes(mapping.scans(), report);
  addMap(mapping.map(), report);
  if (errors) addErrors(*errors, report);
  addPoints(mapping, report);
  return report;
}

}  // namespace edgevox
