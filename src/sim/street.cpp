// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "sim/layouts.hpp"
#include "sim/materials.hpp"
#include "sim/random.hpp"

namespace edgevox::sim {
namespace {

using Eigen::Vector3d;

constexpr double kRoadHalf = 4.6;  // m, centre to kerb
constexpr double kFacade = 7.6;    // m, centre to façades
constexpr double kKerb = 0.12;     // m
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

struct Side {
  Place start;    // a corner of the centre line, x along the street, y to the inner block
  double length;  // m, to the next corner
};

std::vector<Side> sidesOf(const Loop& loop) {
  const double x = loop.half_x;
  const double y = loop.half_y;
  return {{{-x, -y, 0.0, 0.0}, 2.0 * x},
          {{x, -y, 0.0, 0.5 * kPi}, 2.0 * y},
          {{x, y, 0.0, kPi}, 2.0 * x},
          {{-x, y, 0.0, -0.5 * kPi}, 2.0 * y}};
}

Place along(const Side& side, double x, double y, double turn = 0.0, double z = 0.0) {
  const Vector3d at = side.start.transform() * Vector3d(x, y, z);
  return {at.x(), at.y(), at.z(), side.start.heading + turn};
}

void addGround(Solids& solids, const Loop& loop) {
  const double out_x = loop.half_x + 45.0;
  const double out_y = loop.half_y + 45.0;
  addBox(solids, {}, {-out_x, -out_y, -0.5}, {out_x, out_y, 0.0}, kAsphalt);
  addBox(solids, {}, {kRoadHalf - loop.half_x, kRoadHalf - loop.half_y, -0.1},
         {loop.half_x - kRoadHalf, loop.half_y - kRoadHalf, kKerb}, kConcrete);
  for (const Side& side : sidesOf(loop)) {
    addBox(solids, side.start, {-kRoadHalf, -40.0, -0.1},
           {side.length + kRoadHalf, -kRoadHalf, kKerb}, kConcrete);
  }
}

// A house whose front runs from `place` along x, facing -y; its front stands back by `back`.
void addHouse(Solids& solids, const Place& place, double width, double depth, Random& random) {
  const int storeys = 2 + static_cast<int>(random.uniform(0.0, 3.0));
  const double height = 3.1 * storeys + 0.6;
  const double back = random.uniform(0.0, 0.5);
  addBox(solids, place, {0.0, back, -0.1}, {width, depth, height}, kBrick);
  addBox(solids, place, {-0.1, back - 0.3, height}, {width + 0.1, depth, height + 0.25}, kPaint);
  addBox(solids, place, {0.0, back - 0.08, 0.0}, {width, back, 0.7}, kConcrete);
  const int axes = std::max(2, static_cast<int>(width / 3.0));
  const int door = static_cast<int>(random.uniform(0.0, axes));
  const bool balconies = random.uniform() < 0.4;
  for (int axis = 0; axis < axes; ++axis) {
    const double x = width * (axis + 0.5) / axes;
    for (int storey = 0; storey < storeys; ++storey) {
      const double z = 0.9 + 3.1 * storey;
      if (storey == 0 && axis == door) {
        addBox(solids, place, {x - 0.8, back - 0.25, 0.0}, {x - 0.6, back, 2.5}, kPaint);
        addBox(solids, place, {x + 0.6, back - 0.25, 0.0}, {x + 0.8, back, 2.5}, kPaint);
        addBox(solids, place, {x - 0.9, back - 0.8, 2.5}, {x + 0.9, back, 2.65}, kPaint);
        continue;
      }
      addBox(solids, place, {x - 0.7, back - 0.15, z}, {x + 0.7, back, z + 0.12}, kPaint);
      addBox(solids, place, {x - 0.7, back - 0.12, z + 1.6}, {x + 0.7, back, z + 1.75}, kPaint);
      if (balconies && storey > 0 && axis % 2 == 0) {
        addBox(solids, place, {x - 1.1, back - 1.1, z - 0.75}, {x + 1.1, back, z - 0.6}, kConcrete);
        addBox(solids, place, {x - 1.1, back - 1.1, z - 0.6}, {x + 1.1, back - 1.02, z + 0.35},
               kMetal);
      }
    }
  }
}

// One row of houses from `begin` to `end` of a side; `inner` says on which side of the street.
void addRow(Solids& solids, const Side& side, bool inner, double begin, double end,
            Random& random) {
  double x = begin;
  while (x < end - 5.0) {
    double width = random.uniform(9.0, 16.0);
    if (end - x - width < 9.0) width = end - x;
    const Place place =
        inner ? along(side, x, kFacade, 0.0, kKerb) : along(side, x + width, -kFacade, kPi, kKerb);
    addHouse(solids, place, width, random.uniform(9.0, 12.0), random);
    x += width;
    if (random.uniform() < 0.3) x += random.uniform(2.0, 5.0);
  }
}

void parkCars(Solids& solids, const Side& side, double y, Random& random) {
  double x = 16.0 + random.uniform(0.0, 4.0);
  while (x < side.length - 16.0) {
    const double length = random.uniform(3.9, 4.7);
    const double turn = (y > 0.0 ? kPi : 0.0) + random.uniform(-0.03, 0.03);
    if (random.uniform() < 0.7) {
      addCar(solids, along(side, x, y + random.uniform(-0.05, 0.1), turn), length);
    }
    x += length + random.uniform(0.8, 3.5);
  }
}

void addPoles(Solids& solids, const Side& side, Random& random) {
  const double kerb = kRoadHalf + 0.6;
  for (double x = 12.0; x < side.length - 8.0; x += 24.0) {
    addLamp(solids, along(side, x, -kerb, 0.0, kKerb), 6.5);
    addLamp(solids, along(side, x + 12.0, kerb, kPi, kKerb), 6.5);
    const double heading = random.uniform(0.0, kPi);
    const double shift = random.uniform(-1.0, 1.0);
    addTree(solids, along(side, x + 7.0 + shift, -kerb, heading, kKerb), 3.2);
  }
  for (const double x : {9.0, side.length - 9.0}) {
    addSign(solids, along(side, x, -kerb, random.uniform(-0.3, 0.3), kKerb));
    addColumn(solids, along(side, x, kerb - 0.3, 0.0, kKerb), 0.06, 0.9, kMetal);
  }
}

}  // namespace

Solids layOutStreet(std::uint64_t seed, double length) {
  const Loop loop(length);
  Solids solids;
  Random random(seed, 2);
  addGround(solids, loop);
  for (const Side& side : sidesOf(loop)) {
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
