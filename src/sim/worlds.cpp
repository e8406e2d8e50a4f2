// SPDX-License-Identifier: BSD-3-Clause
#include "sim/worlds.hpp"

#include <stdexcept>
#include <string>

#include "sim/layouts.hpp"

namespace edgevox::sim {
namespace {

/// So many that each sees a part of what the one before has seen.
int stationsIn(WorldName name) {
  switch (name) {
    case WorldName::Building:
      return 36;
    case WorldName::Street:
      return 12;
    case WorldName::Corridor:
      return 8;
    case WorldName::City:
      return 13;
  }
  return 0;
}

}  // namespace

WorldName parseWorldName(std::string_view name) {
  if (name == "building") return WorldName::Building;
  if (name == "street") return WorldName::Street;
  if (name == "corridor") return WorldName::Corridor;
  if (name == "city") return WorldName::City;
  throw std::invalid_argument("unknown world '" + std::string(name) +
                              "': building, street, corridor or city");
}

World makeWorld(WorldName name, std::uint64_t seed, double street_length) {
  switch (name) {
    case WorldName::Building:
      return World(layOutBuilding(seed));
    case WorldName::Street:
      return World(layOutStreet(seed, street_length));
    case WorldName::Corridor:
      return World(layOutCorridor(seed));
    case WorldName::City:
      return World(layOutCity(seed));
  }
  throw std::invalid_argument("unknown world");
}

Movers makeMovers(WorldName name, std::uint64_t seed) {
  if (name == WorldName::Building) return moveInBuilding(seed);
  throw std::invalid_argument("things move in the building only");
}

Trajectory makeTrajectory(WorldName name, double street_length) {
  switch (name) {
    case WorldName::Building:
      return walkBuilding();
    case WorldName::Street:
      return driveStreet(street_length);
    case WorldName::Corridor:
      return walkCorridor();
    case WorldName::City:
      return driveCity();
  }
  throw std::invalid_argument("unknown world");
}

Trajectory makeTrajectory(WorldName name, const Sensor& sensor, double street_length) {
  const Trajectory path = makeTrajectory(name, street_length);
  return sensor.standing ? path.stations(stationsIn(name), sensor.period) : path;
}

double sensorHeight(WorldName name) {
  const bool driven = name == WorldName::Street || name == WorldName::City;
  return driven ? kCarSensorHeight : kHandSensorHeight;
}

}  // namespace edgevox::sim
