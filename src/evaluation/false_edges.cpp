// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/false_edges.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace edgevox {
namespace {

constexpr double kLift = 0.002;         // m, of a surface point out of the solid
constexpr double kGradientStep = 1e-4;  // m
constexpr double kMoverReach = 1.5;     // voxels, from what has moved and from what stands still

/// Steps over the window around its middle, in the order of a flood fill.
template <int kWidth>
std::vector<bool> connected(const std::vector<bool>& there) {
  std::vector<bool> reached(there.size(), false);
  std::vector<int> open;
  const auto reach = [&](int x, int y, int z) {
    if (std::min({x, y, z}) < 0 || std::max({x, y, z}) >= kWidth) return;
    const int cell = (z * kWidth + y) * kWidth + x;
    if (!there[cell] || reached[cell]) return;
    reached[cell] = true;
    open.push_back(cell);
  };
  const auto reachAround = [&](int x, int y, int z) {
    for (int n = 0; n < 27; ++n) reach(x + n % 3 - 1, y + n / 3 % 3 - 1, z + n / 9 - 1);
  };
  reachAround(kWidth / 2, kWidth / 2, kWidth / 2);
  while (!open.empty()) {
    const int cell = open.back();
    open.pop_back();
    reachAround(cell % kWidth, cell / kWidth % kWidth, cell / kWidth / kWidth);
  }
  return reached;
}

}  // namespace

FalseEdgeJudge::FalseEdgeJudge(const sim::World& world, const sim::Sensor& sensor,
                               std::vector<Pose> T_world_sensor, sim::World moved)
    : world_(world),
      sensor_(sensor),
      T_world_sensor_(std::move(T_world_sensor)),
      moved_(std::move(moved)) {}

bool FalseEdgeJudge::isOfMover(const Eigen::Vector3d& centre, double voxel_size) const {
  const double reach = kMoverReach * voxel_size;
  const double limit = reach + voxel_size;
  return moved_.clearance(centre, limit) <= reach && world_.clearance(centre, limit) > reach;
}

FalseEdgeJudge::SurfacePoint FalseEdgeJudge::surfaceNear(const Eigen::Vector3d& centre,
                                                         double voxel_size) const {
  SurfacePoint surface;
  const double limit = voxel_size;
  const double clearance = world_.clearance(centre, limit);
  if (std::abs(clearance) > 0.5 * voxel_size) return surface;
  Eigen::Vector3d gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = kGradientStep * Eigen::Vector3d::Unit(axis);
    gradient[axis] =
        world_.clearance(centre + step, limit) - world_.clearance(centre - step, limit);
  }
  if (gradient.norm() < kGradientStep) return surface;  // where two surfaces are as near
  surface.normal = gradient.normalized();
  surface.point = centre + (kLift - clearance) * surface.normal;
  surface.there = world_.clearance(surface.point, limit) > 0.0;  // else inside the union
  return surface;
}

FalseEdgeJudge::Window FalseEdgeJudge::surfaceAround(const VoxelIndex& edge, double voxel_size,
                                                     const Pose& T_world_grid) const {
  Window window;
  for (int i = 0; i < kWidth * kWidth * kWidth; ++i) {
    const VoxelIndex v{edge.x + i % kWidth - kReach, edge.y + i / kWidth % kWidth - kReach,
                       edge.z + i / kWidth / kWidth - kReach};
    window[i] = surfaceNear(T_world_grid * voxelCentre(v, voxel_size), voxel_size);
  }
  return window;
}

FalseEdgeCause FalseEdgeJudge::causeOf(const VoxelIndex& edge, const BitGrid<16>& occupied,
                                       double voxel_size, const Pose& T_world_grid) const {
  if (isOfMover(T_world_grid * voxelCentre(edge, voxel_size), voxel_size)) {
    return FalseEdgeCause::kMovedObject;
  }
  const Window window = surfaceAround(edge, voxel_size, T_world_grid);
  std::vector<bool> there;
  for (const SurfacePoint& surface : window) there.push_back(surface.there);
  const std::vector<bool> hanging = connected<kWidth>(there);

  const Pose T_grid_world = T_world_grid.inverse();
  std::array<int, kFalseEdgeCauses> counts{};
  for (size_t i = 0; i < window.size(); ++i) {
    if (!hanging[i]) continue;
    const auto isHeld = [&](double step) {
      const Eigen::Vector3d point = window[i].point + step * voxel_size * window[i].normal;
      return occupied.test(voxelAt(T_grid_world * point, 1.0 / voxel_size));
    };
    if (isHeld(0.0) || isHeld(-0.5) || isHeld(0.5)) continue;
    ++counts[static_cast<size_t>(causeOfMissing(window[i].point))];
  }
  const auto most = std::max_element(counts.begin(), counts.end());
  if (*most == 0) return FalseEdgeCause::kNothingGone;
  return static_cast<FalseEdgeCause>(most - counts.begin());
}

FalseEdgeCause FalseEdgeJudge::causeOfMissing(const Eigen::Vector3d& point) const {
  auto cause = FalseEdgeCause::kRimOfView;
  for (const Pose& T_world_sensor : T_world_sensor_) {
    if (!isInView(T_world_sensor.inverse() * point)) continue;
    const Eigen::Vector3d ray = point - T_world_sensor.translation();
    const double range = ray.norm();
    if (!world_.castRay(T_world_sensor.translation(), ray / range, range)) {
      return FalseEdgeCause::kScanLineGap;
    }
    cause = FalseEdgeCause::kRangeJump;
  }
  return cause;
}

bool FalseEdgeJudge::isInView(const Eigen::Vector3d& in_sensor) const {
  const double range = in_sensor.norm();
  if (range < sensor_.min_range || range > sensor_.max_range) return false;
  const double lowest = sensor_.elevations.front();
  const double highest = sensor_.elevations.back();
  const double half_gap = 0.5 * (highest - lowest) / (sensor_.elevations.size() - 1.0);
  const double elevation = std::asin(in_sensor.z() / range);
  return elevation >= lowest - half_gap && elevation <= highest + half_gap;
}

}  // namespace edgevox
