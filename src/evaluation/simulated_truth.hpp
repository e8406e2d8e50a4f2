// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "evaluation/recorded_scan.hpp"
#include "sim/movers.hpp"
#include "sim/sensor.hpp"
#include "sim/trajectory.hpp"
#include "sim/world.hpp"

namespace edgevox {

/// What is known of a simulated recording only.
struct SimulatedTruth {
  sim::World world;
  sim::Movers movers;    ///< empty: nothing moves
  sim::Trajectory path;  ///< from stamp 0
  sim::Sensor sensor;
  uint64_t seed = 1;
};

/// True if `input` has the form WORLD[+movers]:SENSOR[:SEED] and there is no such file.
bool isSimulated(const std::string& input);

/// Of an input of this form. Throws std::invalid_argument.
SimulatedTruth simulatedTruth(const std::string& input);

/// A sweep with its true pose, see sim::simulateSweep().
RecordedScan simulatedScan(const SimulatedTruth& truth, int sweep);

}  // namespace edgevox
