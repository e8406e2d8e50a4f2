// SPDX-License-Identifier: BSD-3-Clause
// Stairs and street furniture; furniture for rooms is in parts.cpp.
#include <algorithm>
#include <cmath>

#include "sim/materials.hpp"
#include "sim/parts.hpp"

namespace edgevox::sim {
namespace {

using Eigen::Vector3d;

constexpr double kRiser = kFlightRise / (kFlightSteps + 1);
constexpr double kFlightRun = kFlightSteps * kTread;

// A rail over a flight from (y0, z0) to (y1, z1) at `x`, in the part's frame, with a post at
// either end.
void addHandrail(Solids& solids, const Place& place, double x, const Vector3d& from,
                 const Vector3d& to) {
  const double height = 0.9;
  const Vector3d up(0.0, 0.0, height);
  const Vector3d way = to - from;
  const Eigen::Isometry3d T_world_part = place.transform();
  const Eigen::Quaterniond slope(
      Eigen::AngleAxisd(std::atan2(way.z(), way.y()), Vector3d::UnitX()));
  addTurnedBox(solids, T_world_part * (0.5 * (from + to) + up + Vector3d(x, 0.0, 0.0)),
               {0.06, way.norm(), 0.05}, Eigen::Quaterniond(T_world_part.linear()) * slope, kMetal);
  for (const Vector3d& foot : {from, to}) {
    const Vector3d post = foot + Vector3d(x, 0.0, 0.0);
    addBox(solids, place, post - Vector3d(0.025, 0.025, 0.0), post + Vector3d(0.025, 0.025, height),
           kMetal);
  }
}

}  // namespace

void addStairs(Solids& solids, const Place& place, double lower_x, double upper_x) {
  for (int step = 1; step <= kFlightSteps; ++step) {
    const double top = step * kRiser;
    addBox(solids, place, {lower_x, (step - 1) * kTread, 0.0},
           {lower_x + kFlightWidth, step * kTread, top}, kConcrete);
    const double front = kFlightRun - (step - 1) * kTread;
    addBox(solids, place, {upper_x, front - kTread, kFlightRise + top - 0.3},
           {upper_x + kFlightWidth, front, kFlightRise + top}, kConcrete);
  }
  const double left = std::min(lower_x, upper_x);
  const double right = std::max(lower_x, upper_x) + kFlightWidth;
  addBox(solids, place, {left, kFlightRun, kFlightRise - 0.2},
         {right, kFlightRun + kLandingDepth, kFlightRise}, kConcrete);
  // The rails stand on the flights, next to the gap between them.
  const double side = lower_x > upper_x ? 0.05 : kFlightWidth - 0.05;
  const double other = kFlightWidth - side;
  addHandrail(solids, place, lower_x + side, {0.0, 0.1, 0.1},
              {0.0, kFlightRun - 0.1, kFlightRise - 0.2});
  addHandrail(solids, place, upper_x + other, {0.0, kFlightRun - 0.1, kFlightRise + 0.1},
              {0.0, 0.1, 2.0 * kFlightRise - 0.25});
}

void addCar(Solids& solids, const Place& place, double length) {
  const double x = 0.5 * length;
  addBox(solids, place, {-x, -0.87, 0.25}, {x, 0.87, 0.85}, kPaint);
  addBox(solids, place, {-0.42 * length, -0.78, 0.85}, {0.2 * length, 0.78, 1.42}, kMetal);
  const Eigen::Isometry3d T_world_part = place.transform();
  const Eigen::Quaterniond rake(Eigen::AngleAxisd(0.55, Vector3d::UnitY()));
  addTurnedBox(solids, T_world_part * Vector3d(0.2 * length, 0.0, 1.05), {0.9, 1.5, 0.4},
               Eigen::Quaterniond(T_world_part.linear()) * rake, kMetal);
  for (const double wheel_x : {-0.31 * length, 0.31 * length}) {
    for (const double wheel_y : {-0.78, 0.78}) {
      const Vector3d hub = T_world_part * Vector3d(wheel_x, wheel_y, 0.31);
      addRoller(solids, {hub.x(), hub.y(), hub.z(), place.heading}, 0.32, 0.22, kAsphalt);
    }
  }
}

void addLamp(Solids& solids, const Place& place, double height) {
  addColumn(solids, place, 0.09, height, kMetal);
  addBox(solids, place, {-0.05, 0.0, height - 0.25}, {0.05, 1.6, height - 0.17}, kMetal);
  addBox(solids, place, {-0.14, 1.1, height - 0.31}, {0.14, 1.75, height - 0.2}, kMetal);
}

void addSign(Solids& solids, const Place& place) {
  addColumn(solids, place, 0.04, 2.8, kMetal);
  addBox(solids, place, {-0.06, -0.3, 2.1}, {-0.03, 0.3, 2.7}, kPaint);
}

void addTree(Solids& solids, const Place& place, double height) {
  addColumn(solids, place, 0.16, height, kWood);
  const Vector3d top = place.transform() * Vector3d(0.0, 0.0, height);
  for (int layer = 0; layer < 3; ++layer) {
    const double width = 2.2 - 0.5 * layer;
    const Eigen::Quaterniond rotation =
        Eigen::AngleAxisd(place.heading + 0.9 * layer, Vector3d::UnitZ()) *
        Eigen::AngleAxisd(layer == 0 ? 0.0 : 0.15, Vector3d::UnitX());
    addTurnedBox(solids, top + Vector3d(0.0, 0.0, 0.2 + 0.8 * layer), {width, width, 1.1}, rotation,
                 kLeaves);
  }
}

}  // namespace edgevox::sim
