// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sim/solid.hpp"

namespace edgevox::sim {

/// Where a part stands: its origin in the world (m) and its heading (rad about z).
struct Place {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  double heading = 0.0;

  Eigen::Isometry3d transform() const;  ///< T_world_part
};

/// A hole through a wall: `from` to `to` along it and `bottom` to `top` above its foot, m.
struct Opening {
  double from;
  double to;
  double bottom;
  double top;
};

/// A straight wall from (x0, y0) to (x1, y1), centred on that line, m.
struct Wall {
  double x0, y0, x1, y1;
  double thickness;
  double bottom, top;
  std::vector<Opening> openings;  ///< in ascending order, apart
};

using Solids = std::vector<Solid>;

/// The box from `min` to `max` in the part's frame, m.
void addBox(Solids& solids, const Place& place, const Eigen::Vector3d& min,
            const Eigen::Vector3d& max, double reflectivity);

/// A box of `size` centred at `centre` and turned by `rotation`, m, world frame.
void addTurnedBox(Solids& solids, const Eigen::Vector3d& centre, const Eigen::Vector3d& size,
                  const Eigen::Quaterniond& rotation, double reflectivity);

/// An upright cylinder standing at the place, m.
void addColumn(Solids& solids, const Place& place, double radius, double height,
               double reflectivity);

/// A lying cylinder about the part's y axis, centred at the place, m.
void addRoller(Solids& solids, const Place& place, double radius, double width,
               double reflectivity);

void addWall(Solids& solids, const Wall& wall, double reflectivity);

/// A door leaf hinged at the place, reaching along its heading.
void addDoorLeaf(Solids& solids, const Place& hinge, double width);

/// Furniture: the place is the middle of the footprint on the floor, x is to the front.
void addTable(Solids& solids, const Place& place, double length, double width);
void addRoundTable(Solids& solids, const Place& place, double radius);
void addChair(Solids& solids, const Place& place);
void addShelf(Solids& solids, const Place& place, double width, double height);
void addSofa(Solids& solids, const Place& place, double width);

/// A stair that turns once, with the place at its foot: the lower flight climbs along y from
/// y = 0 between `lower_x` and `lower_x + kFlightWidth`, the upper one comes back at `upper_x`.
void addStairs(Solids& solids, const Place& place, double lower_x, double upper_x);

constexpr double kFlightWidth = 1.3;    ///< m
constexpr double kTread = 0.28;         ///< m, depth of a step
constexpr int kFlightSteps = 8;         ///< below each landing
constexpr double kFlightRise = 1.5;     ///< m, of one flight
constexpr double kLandingDepth = 1.41;  ///< m

/// Street furniture: the place is on the ground, x is along the street.
void addCar(Solids& solids, const Place& place, double length);
void addLamp(Solids& solids, const Place& place, double height);
void addSign(Solids& solids, const Place& place);
void addTree(Solids& solids, const Place& place, double height);

}  // namespace edgevox::sim
