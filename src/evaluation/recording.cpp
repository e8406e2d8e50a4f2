// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/recording.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <thread>

#include "evaluation/bag_recording.hpp"
#include "evaluation/scan_folder.hpp"
#include "sim/scanner.hpp"

namespace edgevox {
namespace {

std::vector<int> chosenSweeps(int sweeps, const RecordingOptions& options) {
  std::vector<int> chosen;
  for (size_t sweep = 0; sweep < static_cast<size_t>(sweeps); ++sweep) {
    if (isWanted(sweep, chosen.size(), options)) chosen.push_back(static_cast<int>(sweep));
  }
  return chosen;
}

/// The sweeps on all processors; the result does not depend on their number.
std::vector<RecordedScan> simulateSweeps(const SimulatedTruth& truth,
                                         const std::vector<int>& sweeps) {
  std::vector<RecordedScan> scans(sweeps.size());
  const size_t workers = std::max(1U, std::thread::hardware_concurrency());
  const auto work = [&](size_t first) {
    for (size_t i = first; i < sweeps.size(); i += workers) {
      scans[i] = simulatedScan(truth, sweeps[i]);
    }
  };
  std::vector<std::thread> threads;
  for (size_t worker = 1; worker < workers; ++worker) threads.emplace_back(work, worker);
  work(0);
  for (std::thread& thread : threads) thread.join();
  return scans;
}

Recording simulate(const RecordingOptions& options) {
  if (!options.poses.empty()) {
    throw std::invalid_argument("the poses of a simulated recording are known: leave out --poses");
  }
  Recording recording;
  recording.name = options.input;
  recording.source = "the true ones";
  recording.truth.emplace(simulatedTruth(options.input));
  const SimulatedTruth& truth = *recording.truth;
  const int sweeps = sim::countSweeps(truth.path, truth.sensor);
  recording.scans = simulateSweeps(truth, chosenSweeps(sweeps, options));
  return recording;
}

RecordedScan copyOf(const CloudView& cloud, const Pose& T_map_sensor) {
  RecordedScan scan;
  scan.bytes.assign(cloud.data, cloud.data + cloud.row_step * cloud.height);
  scan.view = cloud;
  scan.view.data = scan.bytes.data();
  scan.T_map_sensor = T_map_sensor;
  return scan;
}

Recording readFolder(const RecordingOptions& options) {
  Recording recording;
  recording.name = recordingName(options.input);
  recording.source =
      "from " + (options.poses.empty() ? recording.name : options.poses.filename().string());
  size_t number = 0;
  folderStream(options.input, options.poses)(
      scansToSee(options), [&](const CloudView& cloud, const TruePose& truth) {
        const size_t taken = recording.scans.size() + recording.without_pose;
        if (!isWanted(number++, taken, options)) return;
        if (truth) {
          recording.scans.push_back(copyOf(cloud, truth(0.0)));
        } else {
          ++recording.without_pose;
        }
      });
  return recording;
}

Recording read(const RecordingOptions& options) {
  if (isSimulated(options.input)) return simulate(options);
  return std::filesystem::is_directory(options.input) ? readFolder(options)
                                                      : readBagRecording(options);
}

}  // namespace

Pose Recording::poseAt(size_t scan, double time_offset) const {
  const RecordedScan& recorded = scans[scan];
  if (truth) return truth->path.poseAt(recorded.view.stamp + time_offset);
  return recorded.poseAt(time_offset);
}

double endOf(const Recording& recording, size_t scan) {
  const sim::Sensor& sensor = recording.truth->sensor;
  return recording.scans[scan].view.stamp + (sensor.standing ? 0.0 : sensor.period);
}

size_t scansToSee(const RecordingOptions& options) {
  const size_t all = std::numeric_limits<size_t>::max();
  if (options.most > (all - options.first) / options.every) return all;
  return options.first + options.most * options.every;
}

bool isWanted(size_t scan, size_t taken, const RecordingOptions& options) {
  return scan >= options.first && (scan - options.first) % options.every == 0 &&
         taken < options.most;
}

Recording makeRecording(const RecordingOptions& options) {
  if (options.every == 0) throw std::invalid_argument("--every must be at least 1");
  if (options.most == 0) throw std::invalid_argument("--scans must be at least 1");
  Recording recording = read(options);
  if (recording.scans.empty()) {
    throw std::invalid_argument("no scan of '" + options.input +
                                "' is left; check --first and --poses");
  }
  return recording;
}

std::vector<Eigen::Vector3d> pointsInWorld(const Recording& recording, size_t scan) {
  return sim::pointsInWorld(sweepOf(recording.scans[scan]), recording.truth->path);
}

}  // namespace edgevox
