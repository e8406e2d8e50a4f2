// SPDX-License-Identifier: BSD-3-Clause
#include "sim/layouts.hpp"
#include "sim/materials.hpp"
#include "sim/random.hpp"

namespace edgevox::sim {
namespace {

constexpr double kNorth = 1.57079632679489661923;
constexpr double kLength = 30.0;  // m of corridor, along x from 0
constexpr double kHalfWidth = 1.2;
constexpr double kCeiling = 2.8;
constexpr double kWall = 0.2;
constexpr double kRoomEnd = kLength + kWall + 9.0;
constexpr double kRoomHalf = 4.5;

void addShell(Solids& solids) {
  const double side = kHalfWidth + 0.5 * kWall;
  const double room_side = kRoomHalf + 0.5 * kWall;
  const double room_start = kLength + 0.5 * kWall;
  const auto wall = [&](double x0, double y0, double x1, double y1,
                        std::vector<Opening> openings = {}) {
    addWall(solids, {x0, y0, x1, y1, kWall, 0.0, kCeiling, std::move(openings)}, kPlaster);
  };
  addBox(solids, {}, {-1.0, -5.5, -0.3}, {kRoomEnd + 1.0, 5.5, 0.0}, kConcrete);
  addBox(solids, {}, {-1.0, -5.5, kCeiling}, {kRoomEnd + 1.0, 5.5, kCeiling + 0.2}, kPlaster);
  wall(-kWall, side, kLength, side);
  wall(-kWall, -side, kLength, -side);
  wall(-0.5 * kWall, -kHalfWidth, -0.5 * kWall, kHalfWidth);
  wall(room_start, -kRoomHalf, room_start, kRoomHalf,
       {{kRoomHalf - 0.7, kRoomHalf + 0.7, 0.0, 2.1}});
  wall(kLength, room_side, kRoomEnd + kWall, room_side);
  wall(kLength, -room_side, kRoomEnd + kWall, -room_side);
  wall(kRoomEnd + 0.5 * kWall, -kRoomHalf, kRoomEnd + 0.5 * kWall, kRoomHalf,
       {{2.0, 3.6, 0.9, 2.2}, {5.4, 7.0, 0.9, 2.2}});
}

void furnishRoom(Solids& solids, Random& random) {
  const double x = kLength + kWall;
  addTable(solids, {x + 4.6, 0.0, 0.0}, 2.0, 1.0);
  for (const double y : {-0.6, 0.6}) {
    for (const double side : {-1.0, 1.0}) {
      addChair(solids, {x + 4.6 + 0.65 * side, y + random.uniform(-0.05, 0.05), 0.0,
                        (side > 0.0 ? 2.0 * kNorth : 0.0) + random.uniform(-0.3, 0.3)});
    }
  }
  addShelf(solids, {x + 2.0, 4.25, 0.0, -kNorth}, 2.0, 2.0);
  addShelf(solids, {x + 6.0, -4.25, 0.0, kNorth}, 2.4, 1.6);
  addSofa(solids, {x + 1.8, -4.0, 0.0, kNorth}, 1.8);
  addColumn(solids, {x + 7.6, 3.6, 0.0}, 0.22, kCeiling, kConcrete);
  addBox(solids, {x, 0.0, 0.0}, {8.2, -4.2, 0.0}, {8.9, -2.6, 1.1}, kWood);
  addBox(solids, {x, 0.0, 0.0}, {0.0, 2.4, 0.0}, {0.5, 3.8, 1.9}, kWood);
}

}  // namespace

Solids layOutCorridor(std::uint64_t seed) {
  Solids solids;
  Random random(seed, 3);
  addShell(solids);
  furnishRoom(solids, random);
  return solids;
}

Trajectory walkCorridor() {
  const double z = kHandSensorHeight;
  const double x = kLength + kWall;
  return Trajectory({{{1.5, 0.0, z}},
                     {{x + 1.8, 0.0, z}},
                     {{x + 2.6, -2.6, z}},
                     {{x + 6.8, -2.4, z}},
                     {{x + 7.4, 0.6, z}},
                     {{x + 6.2, 2.6, z}},
                     {{x + 2.6, 2.4, z}}},
                    Gait{});
}

}  // namespace edgevox::sim
