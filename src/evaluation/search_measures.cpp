// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/search_measures.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "core/scan/scan_sample.hpp"
#include "edgevox/io/number_text.hpp"
#include "edgevox/scan/motion.hpp"
#include "edgevox/scan/voxelizer.hpp"
#include "edgevox/stage_timer.hpp"
#include "edgevox/statistics.hpp"
#include "evaluation/capture.hpp"
#include "evaluation/pcl_search.hpp"
#include "evaluation/placed_scan.hpp"
#include "evaluation/share.hpp"

namespace edgevox {
namespace {

constexpr double kDegrees = 180.0 / M_PI;  // in a radian
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Turns the sensor's axes into level ones, whatever its heading.
Eigen::Matrix3d levelOf(const Pose& T_map_sensor) {
  const Eigen::Matrix3d& rotation = T_map_sensor.linear();
  return rotationOf({0.0, 0.0, -std::atan2(rotation(1, 0), rotation(0, 0))}) * rotation;
}

SearchVerdict verdictOf(const SearchResult& result, const Pose& truth) {
  if (result.outcome == SearchOutcome::kAmbiguous) return SearchVerdict::kAmbiguous;
  if (result.outcome != SearchOutcome::kFound) return SearchVerdict::kNotFound;
  return isFound(truth, result.answers.front().T_map_sensor) ? SearchVerdict::kRight
                                                             : SearchVerdict::kWrong;
}

SearchTrial trialOf(const SearchResult& result, const Pose& truth) {
  SearchTrial trial;
  trial.T_map_sensor = truth;
  trial.verdict = verdictOf(result, truth);
  trial.distance = trial.angle = trial.evidence = trial.runner_up = trial.hit_share = kNaN;
  if (result.answers.empty()) return trial;
  const MatchResult& best = result.answers.front();
  const Pose off = truth.inverse() * best.T_map_sensor;
  trial.distance = off.translation().norm();
  trial.angle = rotationAngle(off) * kDegrees;
  trial.evidence = evidenceOf(best);
  trial.hit_share = best.hit_share;
  if (result.answers.size() > 1) trial.runner_up = evidenceOf(result.answers[1]);
  for (const MatchResult& answer : result.answers) {
    trial.among = trial.among || isFound(truth, answer.T_map_sensor);
  }
  return trial;
}

template <typename Find>
SearchTrial timedTrial(const VoxelScan& scan, const Pose& truth, const Find& find) {
  StageTimer timer(Clock::kWall);
  const SearchResult result = find();
  const double seconds = timer.lap();
  SearchTrial trial = trialOf(result, truth);
  trial.stamp = scan.stamp;
  trial.seconds = seconds;
  return trial;
}

void addCounts(const SearchTrials& method, Table& table) {
  const std::vector<SearchTrial>& trials = method.trials;
  std::array<size_t, kSearchVerdicts> counts{};
  size_t among = 0;
  std::vector<double> distances;
  std::vector<double> angles;
  std::vector<double> seconds;
  for (const SearchTrial& trial : trials) {
    ++counts[static_cast<size_t>(trial.verdict)];
    seconds.push_back(trial.seconds);
    if (trial.verdict == SearchVerdict::kAmbiguous && trial.among) ++among;
    if (trial.verdict != SearchVerdict::kRight) continue;
    distances.push_back(trial.distance);
    angles.push_back(trial.angle);
  }
  const auto share = [&](SearchVerdict verdict) {
    return 1e2 * shareOf(counts[static_cast<size_t>(verdict)], trials.size());
  };
  table.addRow();
  table.set("method", method.method);
  table.set("scans", static_cast<double>(trials.size()));
  table.set("right", share(SearchVerdict::kRight));
  table.set("ambiguous", share(SearchVerdict::kAmbiguous));
  table.set("among", 1e2 * shareOf(among, counts[static_cast<size_t>(SearchVerdict::kAmbiguous)]));
  table.set("not_found", share(SearchVerdict::kNotFound));
  table.set("wrong", share(SearchVerdict::kWrong));
  table.set("distance", 1e2 * quantile(distances, 0.5));
  table.set("distance_p95", 1e2 * quantile(distances, 0.95));
  table.set("angle", quantile(angles, 0.5));
  table.set("seconds", quantile(seconds, 0.5));
  table.set("seconds_p95", quantile(seconds, 0.95));
}

}  // namespace

const char* toString(SearchVerdict verdict) {
  constexpr std::array<const char*, kSearchVerdicts> kNames = {"right", "ambiguous", "not found",
                                                               "wrong"};
  return kNames[static_cast<size_t>(verdict)];
}

std::vector<SearchTrials> measureSearch(const MatchMap& map, const Recording& recording,
                                        const SearchMeasureOptions& options) {
  const GlobalSearch search(map, options.config);
  const auto pcl = options.pcl_every > 0 ? std::make_unique<PclSearch>(map) : nullptr;
  const size_t points = Matcher(options.config.matcher).sampleSize();
  Voxelizer voxelizer(options.config.voxelizer, options.config.voxel_size);
  std::vector<SearchTrials> methods = {{"edgevox", {}}};
  if (pcl) methods.push_back({"FPFH + SAC-IA + ICP of PCL", {}});
  for (size_t i = 0; i < recording.scans.size(); ++i) {
    const TruePose truth = [&](double time) {
      return options.T_map_recording * recording.poseAt(i, time);
    };
    const VoxelScan scan = seenAtOnce(voxelizer.voxelize(recording.scans[i].view), truth);
    SearchRegion region;
    region.tilt = options.config.search.tilt / kDegrees;
    if (!options.level) region.R_level_sensor = levelOf(truth(0.0));
    const ScanSample sample = sampleCentroids(scan, points);
    methods[0].trials.push_back(timedTrial(
        scan, truth(0.0), [&] { return search.search(sample, region, {kAllProcessors}); }));
    if (!pcl || i % options.pcl_every != 0) continue;
    methods[1].trials.push_back(timedTrial(scan, truth(0.0), [&] {
      SearchResult result;
      result.outcome = SearchOutcome::kFound;
      result.answers.resize(1);
      result.answers[0].T_map_sensor = pcl->find(scan);
      return result;
    }));
  }
  return methods;
}

Table searchTable(const std::vector<SearchTrials>& methods) {
  Table table({{"method", "method"},
               {"stamp", "stamp"},
               {"x", "x"},
               {"y", "y"},
               {"z", "z"},
               {"verdict", "verdict"},
               {"among", "among"},
               {"distance_m", "distance"},
               {"angle_deg", "angle"},
               {"evidence", "evidence"},
               {"runner_up", "runner-up"},
               {"hit_share", "hit share"},
               {"seconds", "seconds"}});
  for (const auto& [method, trials] : methods) {
    for (const SearchTrial& trial : trials) {
      const Eigen::Vector3d position = trial.T_map_sensor.translation();
      table.addRow();
      table.set("method", method);
      table.set("stamp", trial.stamp);
      table.set("x", position.x());
      table.set("y", position.y());
      table.set("z", position.z());
      table.set("verdict", toString(trial.verdict));
      table.set("among", trial.among ? 1.0 : 0.0);
      table.set("distance_m", trial.distance);
      table.set("angle_deg", trial.angle);
      table.set("evidence", trial.evidence);
      table.set("runner_up", trial.runner_up);
      table.set("hit_share", trial.hit_share);
      table.set("seconds", trial.seconds);
    }
  }
  return table;
}

std::string searchMarkdown(const Recording& recording, const SearchMeasureOptions& options,
                           const std::vector<SearchTrials>& methods) {
  Table table({{"method", "method"},
               {"scans", "scans", 0},
               {"right", "right [%]", 1},
               {"ambiguous", "ambiguous [%]", 1},
               {"among", "of these with the truth [%]", 1},
               {"not_found", "not found [%]", 1},
               {"wrong", "wrong [%]", 1},
               {"distance", "distance, median [cm]", 1},
               {"distance_p95", "p95", 1},
               {"angle", "angle, median [deg]", 2},
               {"seconds", "time, median [s]", 2},
               {"seconds_p95", "p95", 2}});
  for (const SearchTrials& method : methods) addCounts(method, table);
  return "# Scans found without a guess\n\nScans of " + recording.name + " in the map " +
         options.map_name + ", configuration " + options.config_name +
         ", poses: " + recording.source + ".\n\n" +
         table.markdown({"method", "scans", "right", "ambiguous", "among", "not_found", "wrong",
                         "distance", "distance_p95", "angle", "seconds", "seconds_p95"},
                        1) +
         "\nEach scan is looked for alone in the whole map, " +
         (options.level ? std::string("by a sensor taken as level")
                        : std::string("by a sensor that is told where up is, as by an IMU")) +
         ". Right: found, within " + shortText(kFoundDistance) + " m and " +
         shortText(kFoundAngle) +
         " degree of the truth; ambiguous: other poses fit as well; wrong: found elsewhere. "
         "Distance and angle are those of the right ones; time is wall time on all processors, of "
         "PCL on one. "
         "The scans are deskewed by the true motion.\n";
}

}  // namespace edgevox
