// SPDX-License-Identifier: BSD-3-Clause
// What moves on the building's ground floor, clear of walkBuilding() at any time of a walk.
#include "sim/layouts.hpp"
#include "sim/materials.hpp"
#include "sim/random.hpp"

namespace edgevox::sim {
namespace {

using Eigen::Vector3d;

Mover walker(std::vector<Vector3d> line, Random& random) {
  Mover mover;
  addBox(mover.parts, {}, {-0.15, -0.25, 0.0}, {0.15, 0.25, 1.75}, kCloth);
  mover.line = std::move(line);
  mover.speed = random.uniform(0.8, 1.2);
  mover.lead = random.uniform(0.0, 10.0);
  return mover;
}

// Boxes that stand from the start and are taken away at `end` s.
Mover stack(double x, double y, double end, Random& random) {
  Mover mover;
  const Place turned{0.0, 0.0, 0.0, random.uniform(-0.2, 0.2)};
  addBox(mover.parts, turned, {-0.4, -0.4, 0.0}, {0.4, 0.4, 0.7}, kWood);
  addBox(mover.parts, turned, {-0.35, -0.4, 0.7}, {0.4, 0.3, 1.2}, kWood);
  mover.line = {{x, y, 0.0}};
  mover.end = end;
  return mover;
}

}  // namespace

Movers moveInBuilding(std::uint64_t seed) {
  Random random(seed, 2);
  return {
      walker({{1.2, 5.7, 0.0}, {6.6, 5.7, 0.0}}, random),                     // lobby
      walker({{12.0, 8.0, 0.0}, {15.6, 8.0, 0.0}}, random),                   // corridor
      walker({{9.3, 3.8, 0.0}, {10.6, 3.5, 0.0}, {12.4, 3.5, 0.0}}, random),  // office
      stack(4.6, 4.5, 40.0, random),   // lobby: the walk begins and ends there
      stack(15.2, 6.1, 12.5, random),  // meeting room, in the middle of the visit
  };
}

}  // namespace edgevox::sim
