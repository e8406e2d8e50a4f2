// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>

#include "sim/layouts.hpp"
#include "sim/materials.hpp"
#include "sim/street_parts.hpp"

namespace edgevox::sim {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kBlocks = 8;              // on either axis
constexpr double kPitch = 100.0;        // m, from crossing to crossing
constexpr double kDepth = 14.0;         // m, kept for the houses on a corner
constexpr double kMargin = 45.0;        // m, around the outermost streets
constexpr double kParkShare = 0.15;     // of the blocks
constexpr double kTreeDistance = 14.0;  // m, in a park

/// The i-th crossing on an axis [m].
double crossing(int i) { return kPitch * (i - 0.5 * kBlocks); }

/// Which blocks are parks; around the city there is none.
class Parks {
 public:
  explicit Parks(Random& random) {
    for (bool& park : parks_) park = random.uniform() < kParkShare;
  }

  bool at(int x, int y) const {
    const bool inside = x >= 0 && x < kBlocks && y >= 0 && y < kBlocks;
    return inside && parks_[static_cast<size_t>(y * kBlocks + x)];
  }

 private:
  std::array<bool, static_cast<size_t>(kBlocks* kBlocks)> parks_{};
};

void addGround(Solids& solids) {
  const double out = crossing(kBlocks) + kMargin;
  addBox(solids, {}, {-out, -out, -0.5}, {out, out, 0.0}, kAsphalt);
  for (int y = -1; y <= kBlocks; ++y) {
    for (int x = -1; x <= kBlocks; ++x) {
      const auto from = [&](int i) { return i < 0 ? -out : crossing(i) + kRoadHalf; };
      const auto to = [&](int i) { return i == kBlocks ? out : crossing(i + 1) - kRoadHalf; };
      addBox(solids, {}, {from(x), from(y), -0.1}, {to(x), to(y), kKerb}, kConcrete);
    }
  }
}

/// A church among trees.
void addPark(Solids& solids, double x, double y, Random& random) {
  const Place church{x, y, kKerb, random.uniform(0.0, kPi)};
  const double tower = random.uniform(30.0, 60.0);
  addBox(solids, church, {-8.0, -6.0, -0.1}, {18.0, 6.0, 14.0}, kBrick);
  addBox(solids, church, {-16.0, -4.0, -0.1}, {-8.0, 4.0, tower}, kBrick);
  addBox(solids, church, {-16.3, -4.3, tower}, {-7.7, 4.3, tower + 0.4}, kPaint);
  for (double nave = -5.0; nave < 17.0; nave += 4.0) {
    for (const double side : {-6.4, 6.0}) {
      addBox(solids, church, {nave, side, -0.1}, {nave + 0.8, side + 0.4, 10.0}, kConcrete);
    }
  }
  const double reach = 0.5 * kPitch - kFacade - 4.0;
  for (double tree_y = -reach; tree_y <= reach; tree_y += kTreeDistance) {
    for (double tree_x = -reach; tree_x <= reach; tree_x += kTreeDistance) {
      const double at_x = tree_x + random.uniform(-3.0, 3.0);
      const double at_y = tree_y + random.uniform(-3.0, 3.0);
      const double heading = random.uniform(0.0, kPi);
      const double height = random.uniform(3.0, 5.0);
      if (std::hypot(at_x, at_y) < 22.0) continue;
      addTree(solids, {x + at_x, y + at_y, kKerb, heading}, height);
    }
  }
}

void addStretch(Solids& solids, const Stretch& stretch, double corner, bool left, bool right,
                Random& random) {
  if (left) addRow(solids, stretch, true, corner, stretch.length - corner, random);
  if (right) addRow(solids, stretch, false, corner, stretch.length - corner, random);
  parkCars(solids, stretch, kRoadHalf - 1.1, random);
  parkCars(solids, stretch, 1.1 - kRoadHalf, random);
  addPoles(solids, stretch, random);
}

}  // namespace

Solids layOutCity(std::uint64_t seed) {
  Solids solids;
  Random random(seed, 4);
  const Parks parks(random);
  addGround(solids);
  for (int line = 0; line <= kBlocks; ++line) {
    for (int i = 0; i < kBlocks; ++i) {
      addStretch(solids, {{crossing(i), crossing(line), 0.0, 0.0}, kPitch}, kFacade,
                 !parks.at(i, line), !parks.at(i, line - 1), random);
      addStretch(solids, {{crossing(line), crossing(i), 0.0, 0.5 * kPi}, kPitch}, kFacade + kDepth,
                 !parks.at(line - 1, i), !parks.at(line, i), random);
    }
  }
  for (int y = 0; y < kBlocks; ++y) {
    for (int x = 0; x < kBlocks; ++x) {
      if (!parks.at(x, y)) continue;
      addPark(solids, crossing(x) + 0.5 * kPitch, crossing(y) + 0.5 * kPitch, random);
    }
  }
  return solids;
}

/// Around a corner at every crossing, from one end of the city to the other.
Trajectory driveCity() {
  const double z = kCarSensorHeight;
  const double corner = 5.0;   // m/s, into and out of corners, and at the ends
  const double before = 12.0;  // m
  std::vector<Waypoint> waypoints = {{{crossing(1), crossing(1), z}}};
  const auto driveTo = [&](double x, double y) {
    const Eigen::Vector3d from = waypoints.back().position;
    const Eigen::Vector3d to(x, y, z);
    const Eigen::Vector3d way = before * (to - from).normalized();
    waypoints.push_back({from + way, corner});
    waypoints.push_back({to - way});
    waypoints.push_back({to, corner});
  };
  for (int i = 1; i < kBlocks - 1; ++i) {
    driveTo(crossing(i + 1), crossing(i));
    driveTo(crossing(i + 1), crossing(i + 1));
  }
  Gait drive;
  drive.speed = 8.0;
  drive.smoothing = 1.2;
  drive.sway_position = 0.01;
  drive.sway_angle = 0.008;
  drive.sway_frequency = 1.3;
  return Trajectory(waypoints, drive);
}

}  // namespace edgevox::sim
