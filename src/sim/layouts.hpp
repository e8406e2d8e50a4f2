// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "sim/movers.hpp"
#include "sim/parts.hpp"
#include "sim/trajectory.hpp"
#include "sim/worlds.hpp"

namespace edgevox::sim {

constexpr double kHandSensorHeight = 1.4;  ///< m
constexpr double kCarSensorHeight = 1.8;   ///< m

// The solids of each world and the path through it, world frame, m.
Solids layOutBuilding(std::uint64_t seed);
Trajectory walkBuilding();
Movers moveInBuilding(std::uint64_t seed);

// `length` of the loop.
Solids layOutStreet(std::uint64_t seed, double length);
Trajectory driveStreet(double length);

Solids layOutCity(std::uint64_t seed);
Trajectory driveCity();

Solids layOutCorridor(std::uint64_t seed);
Trajectory walkCorridor();

}  // namespace edgevox::sim
