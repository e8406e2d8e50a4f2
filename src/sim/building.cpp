// SPDX-License-Identifier: BSD-3-Clause
// The building's shell: slabs, walls, stairs. Rooms are in building_rooms.cpp.
#include "sim/building_rooms.hpp"
#include "sim/layouts.hpp"
#include "sim/materials.hpp"
#include "sim/random.hpp"

namespace edgevox::sim {
namespace {

using Eigen::Vector3d;

constexpr double kLength = 24.0;   // m, along x
constexpr double kDepth = 16.0;    // m, along y
constexpr double kStorey = 3.0;    // m, floor to floor
constexpr double kCeiling = 2.8;   // m above the floor
constexpr double kOuter = 0.2;     // m, outer walls
constexpr double kInner = 0.15;    // m, inner walls
constexpr double kStairsY = 9.15;  // m, foot of both stairs
constexpr double kStairsEnd = 12.8;
constexpr double kStairsWidth = 2.8;

Opening door(double from, double width) { return {from, from + width, 0.0, 2.1}; }
Opening window(double from, double width) { return {from, from + width, 0.9, 2.2}; }

void addGround(Solids& solids) {
  addBox(solids, {}, {-18.0, -17.0, -0.6}, {42.0, 33.0, -0.15}, kAsphalt);
  addBox(solids, {}, {0.0, 0.0, -0.3}, {kLength, kDepth, 0.0}, kConcrete);
  addBox(solids, {}, {-1.5, 2.7, -0.3}, {0.0, 5.3, 0.0}, kConcrete);
  addBox(solids, {}, {-18.0, 23.0, -0.15}, {42.0, 23.5, 1.7}, kBrick);
  addBox(solids, {}, {-10.0, -12.0, -0.15}, {14.0, -11.2, 1.1}, kLeaves);
  for (const double x : {-8.0, 4.0, 13.0, 29.0}) {
    addTree(solids, {x, x > 10.0 ? 20.0 : -7.0, -0.15, x}, 3.4);
  }
}

void addSlabs(Solids& solids) {
  const double low = kCeiling;
  const double high = kStorey;
  addBox(solids, {}, {0.0, 0.0, low}, {kLength, kStairsY, high}, kPlaster);
  addBox(solids, {}, {0.0, kStairsEnd, low}, {kLength, kDepth, high}, kPlaster);
  const double stairs = kOuter + kStairsWidth;
  addBox(solids, {}, {stairs, kStairsY, low}, {kLength - stairs, kStairsEnd, high}, kPlaster);
  addBox(solids, {}, {0.0, kStairsY, low}, {kOuter, kStairsEnd, high}, kPlaster);
  addBox(solids, {}, {kLength - kOuter, kStairsY, low}, {kLength, kStairsEnd, high}, kPlaster);
  addBox(solids, {}, {-0.3, -0.3, kStorey + kCeiling}, {kLength + 0.3, kDepth + 0.3, 2.0 * kStorey},
         kConcrete);
}

void addOuterWalls(Solids& solids, double floor, bool entrance) {
  const double top = floor + kCeiling;
  const double half = 0.5 * kOuter;
  std::vector<Opening> row;
  for (const double x : {1.4, 4.6, 8.8, 11.0, 14.2, 16.4, 19.4, 21.6}) {
    row.push_back(window(x, 1.5));
  }
  addWall(solids, {0.0, half, kLength, half, kOuter, floor, top, row}, kBrick);
  addWall(solids, {0.0, kDepth - half, kLength, kDepth - half, kOuter, floor, top, row}, kBrick);
  const Opening west = entrance ? door(2.9, 1.8) : window(2.7, 1.8);
  addWall(solids,
          {half, kOuter, half, kDepth - kOuter, kOuter, floor, top, {west, window(7.1, 1.4)}},
          kBrick);
  addWall(solids,
          {kLength - half,
           kOuter,
           kLength - half,
           kDepth - kOuter,
           kOuter,
           floor,
           top,
           {window(2.4, 1.8), window(7.1, 1.4)}},
          kBrick);
}

// The walls around both stairs, with doors to the rooms behind them.
void addStairsWalls(Solids& solids, double floor) {
  const double top = floor + kCeiling;
  for (const double x : {3.075, kLength - 3.075}) {
    addWall(solids, {x, kStairsY, x, kDepth - kOuter, kInner, floor, top, {door(4.6, 1.0)}},
            kPlaster);
  }
  const double y = kStairsEnd + 0.5 * kInner;
  addWall(solids, {kOuter, y, 3.0, y, kInner, floor, top, {}}, kPlaster);
  addWall(solids, {kLength - 3.0, y, kLength - kOuter, y, kInner, floor, top, {}}, kPlaster);
}

void addGroundWalls(Solids& solids) {
  const double south = 6.925;
  const double north = 9.075;
  const auto across = [&](double x, double from, double to, std::vector<Opening> openings) {
    addWall(solids, {x, from, x, to, kInner, 0.0, kCeiling, std::move(openings)}, kPlaster);
  };
  addWall(solids,
          {8.0,
           south,
           kLength - kOuter,
           south,
           kInner,
           0.0,
           kCeiling,
           {door(1.95, 1.1), door(8.65, 1.1), door(11.6, 1.0)}},
          kPlaster);
  addWall(solids,
          {3.0,
           north,
           21.0,
           north,
           kInner,
           0.0,
           kCeiling,
           {door(1.6, 1.0), door(8.2, 1.7), door(13.2, 1.0)}},
          kPlaster);
  across(8.075, kOuter, 6.85, {});
  across(13.075, kOuter, 6.85, {door(4.05, 1.1)});
  across(18.575, kOuter, 6.85, {});
  across(9.075, kStairsY, kDepth - kOuter, {});
  across(14.575, kStairsY, kDepth - kOuter, {door(4.2, 1.0)});
}

void addUpperWalls(Solids& solids) {
  const double south = 6.925;
  const double north = 9.075;
  const double top = kStorey + kCeiling;
  const auto across = [&](double x, double from, double to, std::vector<Opening> openings) {
    addWall(solids, {x, from, x, to, kInner, kStorey, top, std::move(openings)}, kPlaster);
  };
  addWall(solids,
          {kOuter,
           south,
           kLength - kOuter,
           south,
           kInner,
           kStorey,
           top,
           {door(2.2, 1.0), door(7.25, 1.1), door(15.75, 1.1), door(19.6, 1.0)}},
          kPlaster);
  addWall(solids,
          {3.0,
           north,
           21.0,
           north,
           kInner,
           kStorey,
           top,
           {door(2.4, 1.0), door(7.3, 1.0), door(14.5, 1.0)}},
          kPlaster);
  across(5.075, kOuter, 6.85, {});
  across(18.575, kOuter, 6.85, {door(1.2, 1.0)});
  across(8.075, kStairsY, kDepth - kOuter, {});
  across(15.075, kStairsY, kDepth - kOuter, {door(4.8, 1.0)});
}

// Guard rails where the upper corridor meets the void over the lower flights.
void addGuardRail(Solids& solids, double from, double to) {
  const Place place{0.0, kStairsY - 0.06, kStorey};
  addBox(solids, place, {from, -0.03, 0.95}, {to, 0.03, 1.0}, kMetal);
  addBox(solids, place, {from, -0.02, 0.45}, {to, 0.02, 0.49}, kMetal);
  for (double x = from + 0.03; x < to; x += 0.6) {
    addBox(solids, place, {x - 0.02, -0.02, 0.0}, {x + 0.02, 0.02, 0.95}, kMetal);
  }
}

}  // namespace

Solids layOutBuilding(std::uint64_t seed) {
  Solids solids;
  Random random(seed, 1);
  addGround(solids);
  addSlabs(solids);
  for (const double floor : {0.0, kStorey}) {
    addOuterWalls(solids, floor, floor == 0.0);
    addStairsWalls(solids, floor);
  }
  addGroundWalls(solids);
  addUpperWalls(solids);
  addStairs(solids, {0.0, kStairsY, 0.0}, 22.5, 21.0);
  addStairs(solids, {0.0, kStairsY, 0.0}, 0.2, 1.7);
  addGuardRail(solids, 22.45, 23.8);
  addGuardRail(solids, 0.2, 1.55);
  furnishGroundFloor(solids, random);
  furnishUpperFloor(solids, kStorey, random);
  return solids;
}

Trajectory walkBuilding() {
  const double low = kHandSensorHeight;
  const double landing = low + kFlightRise;
  const double high = low + kStorey;
  const double top_y = kStairsY + kFlightSteps * kTread;
  const double turn_y = top_y + 0.5 * kLandingDepth;
  const double climb = 0.8;  // m/s
  const std::vector<Waypoint> waypoints = {
      {{5.0, 8.0, low}},
      {{10.5, 8.0, low}},
      {{10.5, 4.8, low}},
      {{17.2, 4.8, low}},
      {{17.2, 8.0, low}},
      {{23.15, 8.0, low}},
      {{23.15, 9.0, low}},
      {{23.15, top_y, landing}, climb},
      {{23.15, turn_y, landing}, climb},
      {{21.65, turn_y, landing}, climb},
      {{21.65, top_y, landing}, climb},
      {{21.65, 9.0, high}, climb},
      {{21.65, 8.0, high}},
      {{16.5, 8.0, high}},
      {{16.5, 3.8, high}},
      {{8.0, 3.8, high}},
      {{8.0, 8.0, high}},
      {{2.35, 8.0, high}},
      {{2.35, 9.0, high}},
      {{2.35, top_y, landing}, climb},
      {{2.35, turn_y, landing}, climb},
      {{0.85, turn_y, landing}, climb},
      {{0.85, top_y, landing}, climb},
      {{0.85, 9.0, low}, climb},
      {{0.85, 8.0, low}},
      {{5.0, 8.0, low}},
  };
  return Trajectory(waypoints, Gait{});
}

}  // namespace edgevox::sim
