// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

#include "sim/movers.hpp"
#include "sim/sensor.hpp"
#include "sim/trajectory.hpp"
#include "sim/world.hpp"

namespace edgevox::sim {

enum class WorldName { Building, Street, Corridor, City };

/// "building", "street", "corridor" or "city". Throws std::invalid_argument otherwise.
WorldName parseWorldName(std::string_view name);

constexpr double kStreetLength = 520.0;  ///< m, of the loop of streets, unless it is longer

/// Two storeys with stairs, a loop of streets, a bare corridor that ends in a room, or a city of
/// 800 x 800 m. The seed moves furniture, door leaves, façades, parked cars and parks, never the
/// walls of rooms. The loop is `street_length` m long, at least kStreetLength; no stretch of it is
/// like another.
World makeWorld(WorldName name, std::uint64_t seed, double street_length = kStreetLength);

/// People who walk about on the ground floor and boxes that are taken away, all at least 0.6 m from
/// the path; the seed varies how they walk. Throws std::invalid_argument for worlds other than the
/// building.
Movers makeMovers(WorldName name, std::uint64_t seed);

/// The path of a carried or driven sensor through the world, at rest at both ends; building and
/// street end in the pose they begin in. Keeps at least 0.35 m from every solid.
Trajectory makeTrajectory(WorldName name, double street_length = kStreetLength);

/// The path for this sensor: makeTrajectory, or stations along it for a standing sensor.
Trajectory makeTrajectory(WorldName name, const Sensor& sensor,
                          double street_length = kStreetLength);

/// Height of the sensor above the ground it moves over, m.
double sensorHeight(WorldName name);

}  // namespace edgevox::sim
