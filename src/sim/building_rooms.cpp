// SPDX-License-Identifier: BSD-3-Clause
#include "sim/building_rooms.hpp"

#include <cmath>

#include "sim/materials.hpp"

namespace edgevox::sim {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kEast = 0.0;
constexpr double kNorth = 0.5 * kPi;
constexpr double kWest = kPi;
constexpr double kSouth = -0.5 * kPi;
constexpr double kCeiling = 2.8;

void addTurnedChair(Solids& solids, Place place, Random& random) {
  place.x += random.uniform(-0.06, 0.06);
  place.y += random.uniform(-0.06, 0.06);
  place.heading += random.uniform(-0.4, 0.4);
  addChair(solids, place);
}

// A table with its length along y before the turn, and a chair behind it facing it.
void addDesk(Solids& solids, const Place& place, Random& random) {
  addTable(solids, place, 1.6, 0.8);
  const Eigen::Vector3d seat = place.transform() * Eigen::Vector3d(-0.65, 0.0, 0.0);
  addTurnedChair(solids, {seat.x(), seat.y(), place.z, place.heading}, random);
  addBox(solids, place, {0.05, -0.3, 0.85}, {0.09, 0.3, 1.2}, kMetal);
  addBox(solids, place, {0.0, -0.12, 0.75}, {0.14, 0.12, 0.85}, kMetal);
}

void addMeetingTable(Solids& solids, const Place& place, double length, Random& random) {
  addTable(solids, place, length, 1.3);
  for (double y = -0.5 * length + 0.5; y < 0.5 * length; y += 0.8) {
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector3d seat = place.transform() * Eigen::Vector3d(side * 0.85, y, 0.0);
      const double heading = place.heading + (side > 0.0 ? kPi : 0.0);
      addTurnedChair(solids, {seat.x(), seat.y(), place.z, heading}, random);
    }
  }
}

void addSquareColumn(Solids& solids, double x, double y, double floor) {
  addBox(solids, {x, y, floor}, {-0.18, -0.18, 0.0}, {0.18, 0.18, kCeiling}, kConcrete);
}

void addRoundColumn(Solids& solids, double x, double y, double floor) {
  addColumn(solids, {x, y, floor}, 0.2, kCeiling, kConcrete);
}

void addBlock(Solids& solids, double x0, double y0, double x1, double y1, double floor,
              double height) {
  addBox(solids, {0.0, 0.0, floor}, {x0, y0, 0.0}, {x1, y1, height}, kWood);
}

void furnishLobby(Solids& solids, Random& random) {
  addRoundColumn(solids, 3.0, 6.6, 0.0);
  addRoundColumn(solids, 6.2, 6.6, 0.0);
  addSquareColumn(solids, 3.0, 3.2, 0.0);
  addSquareColumn(solids, 6.2, 3.2, 0.0);
  addBlock(solids, 6.3, 0.9, 6.9, 2.6, 0.0, 1.1);
  addBlock(solids, 6.9, 2.0, 8.0, 2.6, 0.0, 1.1);
  addTurnedChair(solids, {7.4, 1.3, 0.0, kWest}, random);
  addSofa(solids, {2.4, 0.7, 0.0, kNorth}, 2.0);
  addSofa(solids, {4.4, 0.7, 0.0, kNorth}, 1.5);
  addRoundTable(solids, {2.6, 1.9, 0.0}, 0.4);
  addShelf(solids, {7.75, 5.2, 0.0, kWest}, 1.6, 1.9);
}

void furnishSouthRooms(Solids& solids, Random& random) {
  addDesk(solids, {9.6, 2.0, 0.0, kSouth}, random);
  addDesk(solids, {11.7, 2.0, 0.0, kSouth}, random);
  addShelf(solids, {8.4, 4.4, 0.0, kEast}, 1.8, 2.0);
  addShelf(solids, {12.2, 0.45, 0.0, kNorth}, 1.2, 2.0);
  addBlock(solids, 11.9, 6.3, 12.9, 6.85, 0.0, 1.3);
  addMeetingTable(solids, {15.6, 2.2, 0.0, kNorth}, 3.4, random);
  addBlock(solids, 17.9, 0.3, 18.5, 1.7, 0.0, 0.8);
  addBlock(solids, 14.2, 6.79, 15.8, 6.85, 0.9, 1.1);
  addRoundColumn(solids, 13.9, 6.1, 0.0);
  addBlock(solids, 18.65, 0.2, 22.6, 0.8, 0.0, 0.9);
  addBlock(solids, 18.65, 0.2, 21.0, 0.55, 1.5, 0.7);
  addBlock(solids, 23.1, 0.2, 23.8, 0.9, 0.0, 1.9);
  addRoundTable(solids, {21.3, 3.7, 0.0}, 0.6);
  for (int seat = 0; seat < 4; ++seat) {
    const double angle = 0.4 + 0.5 * kPi * seat;
    addTurnedChair(solids,
                   {21.3 + 0.85 * std::cos(angle), 3.7 + 0.85 * std::sin(angle), 0.0, angle + kPi},
                   random);
  }
}

void furnishNorthRooms(Solids& solids, Random& random) {
  for (const double x : {4.2, 5.9, 7.6}) {
    addShelf(solids, {x, 13.6, 0.0, kEast}, 3.2, 2.1);
    addShelf(solids, {x - 0.36, 13.6, 0.0, kWest}, 3.2, 2.1);
  }
  addMeetingTable(solids, {7.2, 10.4, 0.0, kNorth}, 1.8, random);
  addSquareColumn(solids, 10.6, 12.4, 0.0);
  addSquareColumn(solids, 13.0, 12.4, 0.0);
  addTable(solids, {9.6, 12.6, 0.0}, 2.4, 0.8);
  addTable(solids, {11.8, 14.4, 0.0, kNorth + 0.2}, 2.2, 0.9);
  addBlock(solids, 13.4, 14.9, 14.5, 15.8, 0.0, 1.6);
  addBlock(solids, 9.15, 15.1, 10.2, 15.8, 0.0, 0.9);
  addDesk(solids, {15.9, 11.2, 0.0, kWest}, random);
  addDesk(solids, {19.6, 10.6, 0.0, kEast}, random);
  addTable(solids, {17.7, 13.2, 0.0, kNorth}, 3.0, 0.9);
  addColumn(solids, {19.9, 15.0, 0.0}, 0.4, 1.7, kMetal);
  addColumn(solids, {18.9, 15.2, 0.0}, 0.3, 1.3, kMetal);
  addBlock(solids, 0.3, 15.0, 2.4, 15.8, 0.0, 1.2);
  addBlock(solids, 22.0, 15.0, 23.7, 15.8, 0.0, 2.0);
}

}  // namespace

void furnishGroundFloor(Solids& solids, Random& random) {
  furnishLobby(solids, random);
  furnishSouthRooms(solids, random);
  furnishNorthRooms(solids, random);
  // Leaves at the jambs of doorways, swung away from the path where it goes through.
  const auto ajar = [&](double low, double high) { return random.uniform(low, high); };
  addDoorLeaf(solids, {9.93, 6.83, 0.0, kSouth - ajar(0.05, 0.3)}, 1.0);
  addDoorLeaf(solids, {17.77, 6.83, 0.0, kSouth + ajar(0.05, 0.3)}, 1.0);
  addDoorLeaf(solids, {19.63, 6.83, 0.0, kSouth + ajar(0.3, 1.0)}, 0.95);
  addDoorLeaf(solids, {4.63, 9.17, 0.0, kNorth - ajar(0.3, 1.0)}, 0.95);
  addDoorLeaf(solids, {17.17, 9.17, 0.0, kNorth + ajar(0.3, 1.0)}, 0.95);
  addDoorLeaf(solids, {3.17, 14.72, 0.0, kEast - ajar(0.4, 0.9)}, 0.9);
}

void furnishUpperFloor(Solids& solids, double floor, Random& random) {
  const double z = floor;
  for (const double x : {6.5, 10.4, 14.2}) {
    addRoundColumn(solids, x, 5.3, z);
    addSquareColumn(solids, x, 2.4, z);
  }
  for (const double x : {8.2, 11.6, 15.4}) {
    addDesk(solids, {x, 1.9, z, kSouth}, random);
    addDesk(solids, {x, 1.05, z, kNorth}, random);
  }
  addMeetingTable(solids, {12.3, 5.75, z, kNorth}, 2.2, random);
  addShelf(solids, {17.9, 5.6, z, kWest}, 1.8, 2.0);
  addShelf(solids, {5.35, 3.0, z, kEast}, 2.2, 1.4);
  addDesk(solids, {2.2, 2.2, z, kWest}, random);
  addSofa(solids, {0.65, 5.0, z, kEast}, 1.8);
  addShelf(solids, {3.6, 0.4, z, kNorth}, 1.6, 2.0);
  addDesk(solids, {21.4, 3.0, z, kEast + 0.5}, random);
  addRoundTable(solids, {20.2, 5.4, z}, 0.5);
  addBlock(solids, 23.2, 0.2, 23.8, 2.2, z, 1.0);
  addMeetingTable(solids, {5.4, 12.6, z}, 3.2, random);
  addBlock(solids, 3.15, 15.2, 5.0, 15.8, z, 0.9);
  addDesk(solids, {9.4, 14.5, z, kWest}, random);
  addDesk(solids, {9.4, 11.2, z, kWest}, random);
  addTable(solids, {12.0, 12.6, z, 0.3}, 2.0, 1.0);
  addShelf(solids, {14.8, 11.0, z, kWest}, 2.0, 2.1);
  addSquareColumn(solids, 11.6, 10.6, z);
  addSofa(solids, {16.2, 15.1, z, kSouth}, 2.2);
  addTable(solids, {19.4, 12.4, z}, 1.8, 0.9);
  addShelf(solids, {18.2, 15.6, z, kSouth}, 1.4, 1.8);
  addRoundColumn(solids, 18.0, 11.2, z);
  addBlock(solids, 0.3, 15.1, 2.0, 15.8, z, 1.6);
  const auto ajar = [&](double low, double high) { return random.uniform(low, high); };
  addDoorLeaf(solids, {17.03, 6.83, z, kSouth + ajar(0.05, 0.3)}, 1.0);
  addDoorLeaf(solids, {7.47, 6.83, z, kSouth - ajar(0.05, 0.3)}, 1.0);
  addDoorLeaf(solids, {2.43, 6.83, z, kSouth + ajar(0.3, 1.0)}, 0.95);
  addDoorLeaf(solids, {10.33, 9.17, z, kNorth + ajar(0.4, 1.1)}, 0.95);
  addDoorLeaf(solids, {17.53, 9.17, z, kNorth - ajar(-0.9, -0.3)}, 0.95);
}

}  // namespace edgevox::sim
