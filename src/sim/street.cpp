// SPDX-License-Identifier: BSD-3-Clause
#include "sim/layouts.hpp"
#include "sim/materials.hpp"
#include "sim/street_parts.hpp"

namespace edgevox::sim {
namespace {

using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;

// The street's centre line is a rectangle around the origin; cars drive it counter-clockwise. What
// is longer than usual is longer on all four sides.
struct Loop {
  double half_x;  // m
  double half_y;  // m

  explicit Loop(double length)
      : half_x(75.0 + (length - kStreetLength) / 8.0),
        half_y(55.0 + (length - kStreetLength) / 8.0) {}
};

std::vector<Stretch> sidesOf(const Loop& loop) {
  const double x = loop.half_x;
  const double y = loop.half_y;
  return {{{-x, -y, 0.0, 0.0}, 2.0 * x},
          {{x, -y, 0.0, 0.5 * kPi}, 2.0 * y},
          {{x, y, 0.0, kPi}, 2.0 * x},
          {{-x, y, 0.0, -0.5 * kPi}, 2.0 * y}};
}

void addGround(Solids& solids, const Loop& loop) {
  const double out_x = loop.half_x + 45.0;
  const double out_y = loop.half_y + 45.0;
  addBox(solids, {}, {-out_x, -out_y, -0.5}, {out_x, out_y, 0.0}, kAsphalt);
  addBox(solids, {}, {kRoadHalf - loop.half_x, kRoadHalf - loop.half_y, -0.1},
         {loop.half_x - kRoadHalf, loop.half_y - kRoadHalf, kKerb}, kConcrete);
  for (const Stretch& side : sidesOf(loop)) {
    addBox(solids, side.start, {-kRoadHalf, -40.0, -0.1},
           {side.length + kRoadHalf, -kRoadHalf, kKerb}, kConcrete);
  }
}

}  // namespace

Solids layOutStreet(std::uint64_t seed, double length) {
  const Loop loop(length);
  Solids solids;
  Random random(seed, 2);
  addGround(solids, loop);
  for (const Stretch& side : sidesOf(loop)) {
    const bool long_side = side.length > 2.0 * loop.half_y;
    const double corner = long_side ? kFacade : kFacade + 14.0;
    addRow(solids, side, true, corner, side.length - corner, random);
    addRow(solids, side, false, kFacade - 20.0, side.length - kFacade - 3.0, random);
    parkCars(solids, side, kRoadHalf - 1.1, random);
    parkCars(solids, side, 1.1 - kRoadHalf, random);
    addPoles(solids, side, random);
  }
  return solids;
}

Trajectory driveStreet(double length) {
  const Loop loop(length);
  const double x = loop.half_x;
  const double y = loop.half_y;
  const double z = kCarSensorHeight;
  const double corner = 5.0;  // m/s, into and out of corners, and at the ends
  const double near_x = x - 12.0;
  const double near_y = y - 12.0;
  Gait drive;
  drive.speed = 8.0;
  drive.smoothing = 1.2;
  drive.sway_position = 0.01;
  drive.sway_angle = 0.008;
  drive.sway_frequency = 1.3;
  return Trajectory({{{-10.0, -y, z}},
                     {{0.0, -y, z}, corner},
                     {{near_x, -y, z}},
                     {{x, -y, z}, corner},
                     {{x, -near_y, z}, corner},
                     {{x, near_y, z}},
                     {{x, y, z}, corner},
                     {{near_x, y, z}, corner},
                     {{-near_x, y, z}},
                     {{-x, y, z}, corner},
                     {{-x, near_y, z}, corner},
                     {{-x, -near_y, z}},
                     {{-x, -y, z}, corner},
                     {{-near_x, -y, z}, corner},
                     {{-20.0, -y, z}},
                     {{-10.0, -y, z}, corner}},
                    drive);
}

}  // namespace edgevox::sim
