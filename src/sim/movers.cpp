// SPDX-License-Identifier: BSD-3-Clause
#include "sim/movers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace edgevox::sim {
namespace {

using Line = std::vector<Eigen::Vector3d>;

constexpr double kStep = 0.1;  // s, in which a walker moves by less than it is deep

double lengthOf(const Line& line) {
  double length = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  return length;
}

// The way walked on a line of `length` to and fro, as the distance from its start.
double foldedWay(double way, double length) { return std::abs(std::remainder(way, 2.0 * length)); }

Eigen::Isometry3d poseOnLeg(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double way) {
  const Eigen::Vector3d ahead = (to - from).normalized();
  return Eigen::Translation3d(from + way * ahead) *
         Eigen::AngleAxisd(std::atan2(ahead.y(), ahead.x()), Eigen::Vector3d::UnitZ());
}

void addPartsAt(const Mover& mover, const Eigen::Isometry3d& T_world_mover, Solids& solids) {
  for (Solid part : mover.parts) {
    part.T_world_solid = T_world_mover * part.T_world_solid;
    solids.push_back(part);
  }
}

}  // namespace

Eigen::Isometry3d Mover::poseAt(double time) const {
  if (line.size() < 2) return Eigen::Isometry3d(Eigen::Translation3d(line.front()));
  double way = foldedWay(lead + speed * time, lengthOf(line));
  std::size_t leg = 1;
  for (; leg + 1 < line.size(); ++leg) {
    const double length = (line[leg] - line[leg - 1]).norm();
    if (way <= length) break;
    way -= length;
  }
  return poseOnLeg(line[leg - 1], line[leg], way);
}

Solids solidsAt(const Movers& movers, double time) {
  Solids solids;
  for (const Mover& mover : movers) {
    if (mover.isThere(time)) addPartsAt(mover, mover.poseAt(time), solids);
  }
  return solids;
}

World volumeOf(const Movers& movers, double from, double to) {
  Solids solids;
  for (const Mover& mover : movers) {
    const double first = std::max(from, mover.begin);
    const double last = std::min(to, mover.end);
    if (first > to || last <= from) continue;
    addPartsAt(mover, mover.poseAt(first), solids);
    if (mover.speed == 0.0) continue;
    for (double time = first + kStep; time < last; time += kStep) {
      addPartsAt(mover, mover.poseAt(time), solids);
    }
    addPartsAt(mover, mover.poseAt(last), solids);
  }
  return World(std::move(solids));
}

}  // namespace edgevox::sim
