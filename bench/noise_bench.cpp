// SPDX-License-Identifier: BSD-3-Clause
// What points at random cost: the same sweeps with and without them, through the whole pipeline.
#include <random>
#include <vector>

#include "benchmarks.hpp"
#include "edgevox/mapping/pipeline.hpp"
#include "sim/scanner.hpp"
#include "sim/worlds.hpp"

namespace edgevox::bench {
namespace {

using benchmark::State;
using Points = std::vector<Eigen::Vector3f>;

constexpr int kSweeps = 200;          // time is taken in the second half
constexpr int kNoisePoints = 1000;    // a sweep
constexpr float kNoiseReach = 60.0F;  // to each side of the sensor [m]

/// Sweeps in the simulated building while it is walked through, as points in the sensor's frame.
const std::vector<Points>& sweeps() {
  static const std::vector<Points> made = [] {
    const sim::Sensor sensor = sim::makeSensor("32");
    const sim::World world = sim::makeWorld(sim::WorldName::Building, 1);
    const sim::Trajectory path = sim::makeTrajectory(sim::WorldName::Building, sensor);
    std::vector<Points> all;
    for (int i = 0; i < kSweeps; ++i) {
      all.push_back(sim::simulateSweep(world, path, sensor, i, 1).points);
    }
    return all;
  }();
  return made;
}

void mapSweeps(State& state, int noise_points) {
  std::mt19937 engine(1);
  const auto coordinate = [&] {
    return kNoiseReach * (static_cast<float>(engine()) * 0x1p-31F - 1.0F);
  };
  while (state.KeepRunningBatch(kSweeps / 2)) {
    state.PauseTiming();
    Pipeline pipeline(Config{});
    for (size_t i = 0; i < sweeps().size(); ++i) {
      Points points = sweeps()[i];
      for (int n = 0; n < noise_points; ++n) {
        points.push_back({coordinate(), coordinate(), coordinate()});
      }
      const bool timed = i >= kSweeps / 2;
      if (timed) state.ResumeTiming();
      const auto result = pipeline.process(viewOf(points, 0.1 * static_cast<double>(i), "lidar"));
      if (timed) state.PauseTiming();
      if (!result.scan.located()) state.SkipWithError("a scan was lost");
    }
    state.counters["map_MB"] = static_cast<double>(pipeline.map().bytes()) * 1e-6;
    state.ResumeTiming();
  }
}

}  // namespace

void addNoiseBenchmarks() {
  add("pipeline", "room", [](State& state, const std::string&) { mapSweeps(state, 0); });
  add("pipeline", "noisy_room",
      [](State& state, const std::string&) { mapSweeps(state, kNoisePoints); });
}

}  // namespace edgevox::bench
