// SPDX-License-Identifier: BSD-3-Clause
#include "sim/parts.hpp"

#include <cmath>

#include "sim/materials.hpp"

namespace edgevox::sim {

using Eigen::Vector3d;

Eigen::Isometry3d Place::transform() const {
  Eigen::Isometry3d T_world_part = Eigen::Isometry3d::Identity();
  T_world_part.translation() = Vector3d(x, y, z);
  T_world_part.linear() = Eigen::AngleAxisd(heading, Vector3d::UnitZ()).toRotationMatrix();
  return T_world_part;
}

void addBox(Solids& solids, const Place& place, const Vector3d& min, const Vector3d& max,
            double reflectivity) {
  Solid box;
  box.T_world_solid = place.transform() * Eigen::Translation3d(0.5 * (min + max));
  box.half = 0.5 * (max - min);
  box.reflectivity = reflectivity;
  solids.push_back(box);
}

void addTurnedBox(Solids& solids, const Vector3d& centre, const Vector3d& size,
                  const Eigen::Quaterniond& rotation, double reflectivity) {
  Solid box;
  box.T_world_solid = Eigen::Translation3d(centre) * rotation.normalized();
  box.half = 0.5 * size;
  box.reflectivity = reflectivity;
  solids.push_back(box);
}

void addColumn(Solids& solids, const Place& place, double radius, double height,
               double reflectivity) {
  Solid cylinder;
  cylinder.shape = Shape::Cylinder;
  cylinder.T_world_solid = place.transform() * Eigen::Translation3d(0.0, 0.0, 0.5 * height);
  cylinder.half = Vector3d(radius, radius, 0.5 * height);
  cylinder.reflectivity = reflectivity;
  solids.push_back(cylinder);
}

void addRoller(Solids& solids, const Place& place, double radius, double width,
               double reflectivity) {
  Solid cylinder;
  cylinder.shape = Shape::Cylinder;
  Eigen::Matrix3d lying;  // columns: the cylinder's axes in the part's frame
  lying << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  cylinder.T_world_solid = place.transform();
  cylinder.T_world_solid.linear() = cylinder.T_world_solid.linear() * lying;
  cylinder.half = Vector3d(radius, radius, 0.5 * width);
  cylinder.reflectivity = reflectivity;
  solids.push_back(cylinder);
}

void addWall(Solids& solids, const Wall& wall, double reflectivity) {
  const double dx = wall.x1 - wall.x0;
  const double dy = wall.y1 - wall.y0;
  const double length = std::hypot(dx, dy);
  const double half = 0.5 * wall.thickness;
  const double height = wall.top - wall.bottom;
  const Place foot{wall.x0, wall.y0, wall.bottom, std::atan2(dy, dx)};
  const auto piece = [&](double from, double to, double bottom, double top) {
    if (to <= from || top <= bottom) return;
    addBox(solids, foot, {from, -half, bottom}, {to, half, top}, reflectivity);
  };
  double start = 0.0;
  for (const Opening& opening : wall.openings) {
    piece(start, opening.from, 0.0, height);
    piece(opening.from, opening.to, 0.0, opening.bottom);
    piece(opening.from, opening.to, opening.top, height);
    start = opening.to;
  }
  piece(start, length, 0.0, height);
}

void addDoorLeaf(Solids& solids, const Place& hinge, double width) {
  addBox(solids, hinge, {0.0, -0.02, 0.01}, {width, 0.02, 2.05}, kWood);
}

void addTable(Solids& solids, const Place& place, double length, double width) {
  const double x = 0.5 * width;
  const double y = 0.5 * length;
  addBox(solids, place, {-x, -y, 0.71}, {x, y, 0.75}, kWood);
  for (const double sx : {-1.0, 1.0}) {
    for (const double sy : {-1.0, 1.0}) {
      const Vector3d leg(sx * (x - 0.06), sy * (y - 0.06), 0.0);
      addBox(solids, place, leg - Vector3d(0.03, 0.03, 0.0), leg + Vector3d(0.03, 0.03, 0.71),
             kMetal);
    }
  }
}

void addRoundTable(Solids& solids, const Place& place, double radius) {
  Place top = place;
  top.z += 0.71;
  addColumn(solids, top, radius, 0.04, kWood);
  addColumn(solids, place, 0.05, 0.71, kMetal);
  addColumn(solids, place, 0.6 * radius, 0.03, kMetal);
}

void addChair(Solids& solids, const Place& place) {
  addBox(solids, place, {-0.22, -0.22, 0.42}, {0.22, 0.22, 0.46}, kCloth);
  addBox(solids, place, {-0.22, -0.22, 0.46}, {-0.18, 0.22, 0.92}, kCloth);
  for (const double x : {-0.2, 0.2}) {
    for (const double y : {-0.2, 0.2}) {
      addBox(solids, place, {x - 0.02, y - 0.02, 0.0}, {x + 0.02, y + 0.02, 0.42}, kMetal);
    }
  }
}

void addShelf(Solids& solids, const Place& place, double width, double height) {
  const double y = 0.5 * width;
  addBox(solids, place, {-0.18, -y, 0.0}, {-0.16, y, height}, kWood);
  addBox(solids, place, {-0.16, -y, 0.0}, {0.18, -y + 0.03, height}, kWood);
  addBox(solids, place, {-0.16, y - 0.03, 0.0}, {0.18, y, height}, kWood);
  const int boards = 5;
  for (int board = 0; board < boards; ++board) {
    const double z = 0.05 + board * (height - 0.08) / (boards - 1);
    addBox(solids, place, {-0.16, -y + 0.03, z}, {0.18, y - 0.03, z + 0.03}, kWood);
  }
}

void addSofa(Solids& solids, const Place& place, double width) {
  const double y = 0.5 * width;
  addBox(solids, place, {-0.4, -y, 0.0}, {0.4, y, 0.42}, kCloth);
  addBox(solids, place, {-0.4, -y, 0.42}, {-0.2, y, 0.85}, kCloth);
  addBox(solids, place, {-0.2, -y, 0.42}, {0.4, -y + 0.18, 0.62}, kCloth);
  addBox(solids, place, {-0.2, y - 0.18, 0.42}, {0.4, y, 0.62}, kCloth);
}

}  // namespace edgevox::sim
