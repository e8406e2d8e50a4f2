// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensor.hpp"

#include <stdexcept>

namespace edgevox::sim {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

std::vector<double> spread(int rings, double lowest_degrees, double highest_degrees) {
  std::vector<double> elevations(rings);
  for (int ring = 0; ring < rings; ++ring) {
    elevations[ring] =
        kDegree * (lowest_degrees + (highest_degrees - lowest_degrees) * ring / (rings - 1));
  }
  return elevations;
}

Sensor spinning(int rings, double lowest_degrees, double highest_degrees, int columns,
                double max_range) {
  Sensor sensor;
  sensor.elevations = spread(rings, lowest_degrees, highest_degrees);
  sensor.columns = columns;
  sensor.max_range = max_range;
  return sensor;
}

Sensor terrestrial(int rings, double lowest_degrees, double highest_degrees, int columns,
                   double max_range) {
  Sensor sensor = spinning(rings, lowest_degrees, highest_degrees, columns, max_range);
  sensor.noise = 0.002;
  sensor.period = 1.0;
  sensor.standing = true;
  return sensor;
}

}  // namespace

Sensor makeSensor(std::string_view name) {
  Sensor sensor;
  if (name == "16") {
    sensor = spinning(16, -15.0, 15.0, 1800, 100.0);
  } else if (name == "32") {
    sensor = spinning(32, -22.5, 22.5, 1024, 100.0);
  } else if (name == "64") {
    sensor = spinning(64, -24.8, 2.0, 1800, 120.0);
  } else if (name == "scanner") {
    sensor = terrestrial(601, -60.0, 90.0, 1440, 80.0);
  } else if (name == "fine-scanner") {
    sensor = terrestrial(2501, -40.0, 60.0, 9000, 600.0);
  } else {
    throw std::invalid_argument("unknown sensor '" + std::string(name) +
                                "': 16, 32, 64, scanner or fine-scanner");
  }
  sensor.name = name;
  return sensor;
}

}  // namespace edgevox::sim
