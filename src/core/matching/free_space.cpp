// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/matching/free_space.hpp"

#include <algorithm>
#include <cmath>

#include "core/grid/ray_traversal.hpp"

namespace edgevox {
namespace {

constexpr double kShortest = 1.5;  // line of sight [m]
constexpr double kEnd = 0.6;       // of it that is not looked at [m]
constexpr double kBehind = 0.4;    // a plane ends a line that is seen through it, at least [m]
constexpr double kBefore = 0.2;    // a plane is the sensor, at least [m]

struct Line {
  Eigen::Vector3d from;
  Eigen::Vector3d to;
};

/// Where a line crosses a plane, as a share of its length; negative: it does not, or hardly.
double crossing(const Line& line, const Plane& plane, const Eigen::Vector3d& centre) {
  const Eigen::Vector3d normal = plane.normal.cast<double>();
  const auto offset = static_cast<double>(plane.offset);
  const double before = normal.dot(line.from - centre) - offset;
  const double after = normal.dot(line.to - centre) - offset;
  if (before * after >= 0 || std::abs(before) < kBefore || std::abs(after) < kBehind) return -1.0;
  return before / (before - after);
}

/// Whether the line crosses a plane of a voxel of level 1 where an occupied voxel is.
bool isBlockedIn(const MatchMap& map, const Line& line, const VoxelIndex& parent) {
  for (int l = MatchMap::kFinestPlanes; l <= MatchMap::kCoarsestPlanes; ++l) {
    const VoxelIndex v = coarser(parent, l - 1);
    const VoxelPlanes* planes = map.planes(l).find(v);
    if (planes == nullptr) continue;
    return std::any_of(planes->begin(), planes->end(), [&](const Plane& plane) {
      const double at = crossing(line, plane, voxelCentre(v, map.voxelSize(l)));
      if (at < 0) return false;
      const Eigen::Vector3d point = line.from + at * (line.to - line.from);
      const VoxelIndex crossed = voxelAt(point, 1.0 / map.voxelSize(0));
      return coarser(crossed, 1) == parent && map.hitVoxels().test(crossed);
    });
  }
  return false;
}

bool isBlocked(const MatchMap& map, const Line& line, double length) {
  const double inverse_size = 1.0 / map.voxelSize(1);
  const Eigen::Vector3d end = line.from + (1.0 - kEnd / length) * (line.to - line.from);
  bool blocked = false;
  forEachOnRay(map.occupied(1), line.from * inverse_size, end * inverse_size,
               [&](const VoxelIndex& v) { blocked = blocked || isBlockedIn(map, line, v); });
  return blocked;
}

}  // namespace

double blockedShare(const MatchMap& map, const std::vector<Eigen::Vector3d>& points, size_t count,
                    const Pose& T_map_sensor) {
  size_t lines = 0;
  size_t blocked = 0;
  for (size_t i = 0; i < std::min(count, points.size()); ++i) {
    const double length = points[i].norm();
    if (length < kShortest) continue;
    ++lines;
    const Line line{T_map_sensor.translation(), T_map_sensor * points[i]};
    blocked += isBlocked(map, line, length) ? 1 : 0;
  }
  return lines == 0 ? 0.0 : static_cast<double>(blocked) / static_cast<double>(lines);
}

}  // namespace edgevox
