// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/recording.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

#include "evaluation/bag_recording.hpp"
#include "sim/scanner.hpp"
#include "sim/worlds.hpp"

namespace edgevox {
namespace {

constexpr std::string_view kWithMovers = "+movers";

struct PackedPoint {
  float x, y, z, time;
};

struct SimulatedInput {
  std::string world;
  bool movers = false;
  std::string sensor;
  uint64_t seed = 1;
};

uint64_t seedOf(const std::string& text, const std::string& input) {
  const bool digits = !text.empty() && text.size() < 10 &&
                      text.find_first_not_of("0123456789") == std::string::npos;
  if (digits) return std::stoull(text);
  throw std::invalid_argument("'" + input + "': the seed must be a whole number, not '" + text +
                              "'");
}

SimulatedInput parseSimulated(const std::string& input) {
  SimulatedInput parsed;
  const size_t first = input.find(':');
  const size_t second = input.find(':', first + 1);
  parsed.world = input.substr(0, first);
  const size_t plus = parsed.world.find(kWithMovers);
  parsed.movers = plus != std::string::npos && plus + kWithMovers.size() == first;
  if (parsed.movers) parsed.world.resize(plus);
  parsed.sensor = input.substr(first + 1, second - first - 1);
  if (second != std::string::npos) parsed.seed = seedOf(input.substr(second + 1), input);
  return parsed;
}

/// The part of a sweep that PackedPoint keeps.
sim::Scan unpacked(const RecordedScan& recorded) {
  sim::Scan scan;
  scan.stamp = recorded.view.stamp;
  for (size_t i = 0; i < recorded.view.width; ++i) {
    PackedPoint point;
    std::memcpy(&point, &recorded.bytes[i * sizeof(PackedPoint)], sizeof(PackedPoint));
    scan.points.emplace_back(point.x, point.y, point.z);
    scan.times.push_back(point.time);
  }
  return scan;
}

std::vector<int> chosenSweeps(int sweeps, const RecordingOptions& options) {
  std::vector<int> chosen;
  for (size_t sweep = 0; sweep < static_cast<size_t>(sweeps); ++sweep) {
    if (isWanted(sweep, chosen.size(), options)) chosen.push_back(static_cast<int>(sweep));
  }
  return chosen;
}

/// The sweeps on all processors; the result does not depend on their number.
std::vector<RecordedScan> simulateSweeps(const SimulatedTruth& truth, uint64_t seed,
                                         const std::vector<int>& sweeps) {
  std::vector<RecordedScan> scans(sweeps.size());
  const size_t workers = std::max(1U, std::thread::hardware_concurrency());
  const auto work = [&](size_t first) {
    for (size_t i = first; i < sweeps.size(); i += workers) {
      scans[i] = recordedScan(
          sim::simulateSweep(truth.world, truth.path, truth.sensor, sweeps[i], seed, truth.movers));
      scans[i].T_map_sensor = truth.path.poseAt(scans[i].view.stamp);
    }
  };
  std::vector<std::thread> threads;
  for (size_t worker = 1; worker < workers; ++worker) threads.emplace_back(work, worker);
  work(0);
  for (std::thread& thread : threads) thread.join();
  return scans;
}

Recording simulate(const RecordingOptions& options) {
  const SimulatedInput input = parseSimulated(options.input);
  if (!options.poses.empty()) {
    throw std::invalid_argument("the poses of a simulated recording are known: leave out --poses");
  }
  const sim::WorldName world = sim::parseWorldName(input.world);
  const sim::Sensor sensor = sim::makeSensor(input.sensor);
  sim::Movers movers = input.movers ? sim::makeMovers(world, input.seed) : sim::Movers{};
  Recording recording;
  recording.name = options.input;
  recording.source = "the true ones";
  recording.truth.emplace(SimulatedTruth{sim::makeWorld(world, input.seed), std::move(movers),
                                         sim::makeTrajectory(world, sensor), sensor});
  const int sweeps = sim::countSweeps(recording.truth->path, sensor);
  recording.scans = simulateSweeps(*recording.truth, input.seed, chosenSweeps(sweeps, options));
  return recording;
}

}  // namespace

RecordedScan recordedScan(const sim::Scan& scan) {
  RecordedScan recorded;
  recorded.bytes.resize(scan.size() * sizeof(PackedPoint));
  for (size_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3f& p = scan.points[i];
    const PackedPoint point{p.x(), p.y(), p.z(), scan.times[i]};
    std::memcpy(&recorded.bytes[i * sizeof(PackedPoint)], &point, sizeof(PackedPoint));
  }
  CloudView& view = recorded.view;
  view.stamp = scan.stamp;
  view.frame = "lidar";
  view.data = recorded.bytes.data();
  view.width = scan.size();
  view.height = 1;
  view.point_step = sizeof(PackedPoint);
  view.row_step = recorded.bytes.size();
  view.time.present = true;
  view.time.offset = offsetof(PackedPoint, time);
  return recorded;
}

Pose Recording::poseAt(size_t scan, double time_offset) const {
  const RecordedScan& recorded = scans[scan];
  if (truth) return truth->path.poseAt(recorded.view.stamp + time_offset);
  const Twist& twist = time_offset < 0.0 ? recorded.before : recorded.after;
  return recorded.T_map_sensor * moved(twist, time_offset);
}

double endOf(const Recording& recording, size_t scan) {
  const sim::Sensor& sensor = recording.truth->sensor;
  return recording.scans[scan].view.stamp + (sensor.standing ? 0.0 : sensor.period);
}

bool isWanted(size_t scan, size_t taken, const RecordingOptions& options) {
  return scan >= options.first && (scan - options.first) % options.every == 0 &&
         taken < options.most;
}

bool isSimulated(const std::string& input) {
  return input.find(':') != std::string::npos && !std::filesystem::exists(input);
}

Recording makeRecording(const RecordingOptions& options) {
  if (options.every == 0) throw std::invalid_argument("--every must be at least 1");
  if (options.most == 0) throw std::invalid_argument("--scans must be at least 1");
  Recording recording = isSimulated(options.input) ? simulate(options) : readBagRecording(options);
  if (recording.scans.empty()) {
    throw std::invalid_argument("no scan of '" + options.input +
                                "' is left; check --first and --poses");
  }
  return recording;
}

std::vector<Eigen::Vector3d> pointsInWorld(const Recording& recording, size_t scan) {
  return sim::pointsInWorld(unpacked(recording.scans[scan]), recording.truth->path);
}

}  // namespace edgevox
