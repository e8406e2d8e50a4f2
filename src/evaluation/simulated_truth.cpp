// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/simulated_truth.hpp"

#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "sim/scanner.hpp"
#include "sim/worlds.hpp"

namespace edgevox {
namespace {

constexpr std::string_view kWithMovers = "+movers";

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

}  // namespace

bool isSimulated(const std::string& input) {
  return input.find(':') != std::string::npos && !std::filesystem::exists(input);
}

SimulatedTruth simulatedTruth(const std::string& input) {
  const SimulatedInput parsed = parseSimulated(input);
  const sim::WorldName world = sim::parseWorldName(parsed.world);
  const sim::Sensor sensor = sim::makeSensor(parsed.sensor);
  sim::Movers movers = parsed.movers ? sim::makeMovers(world, parsed.seed) : sim::Movers{};
  return {sim::makeWorld(world, parsed.seed), std::move(movers), sim::makeTrajectory(world, sensor),
          sensor, parsed.seed};
}

RecordedScan simulatedScan(const SimulatedTruth& truth, int sweep) {
  RecordedScan scan = recordedScan(
      sim::simulateSweep(truth.world, truth.path, truth.sensor, sweep, truth.seed, truth.movers));
  scan.T_map_sensor = truth.path.poseAt(scan.view.stamp);
  return scan;
}

}  // namespace edgevox
