// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "edgevox/grid/block_grid.hpp"
#include "edgevox/grid/voxel.hpp"
#include "sim/sensor.hpp"
#include "sim/world.hpp"

namespace edgevox {

/// Why an edge was found where the world has none: because something else was there, or what most
/// of the missing surface around it is.
enum class FalseEdgeCause {
  kRimOfView,    ///< outside the sensor's field of view or range
  kRangeJump,    ///< in the shadow of something nearer, or facing away
  kScanLineGap,  ///< visible, but not hit or not often enough
  kMovedObject,  ///< near what was there for a while only, and near nothing that stands still
  kNothingGone,  ///< no surface is missing: noise and voxelization
};
constexpr size_t kFalseEdgeCauses = 5;

/// Tells the causes of false edges in a simulated world.
class FalseEdgeJudge {
 public:
  /// `world` must outlive this. `T_world_sensor`: the poses from which the voxels were seen.
  /// `moved`: what was occupied for a while only.
  FalseEdgeJudge(const sim::World& world, const sim::Sensor& sensor,
                 std::vector<Pose> T_world_sensor, sim::World moved = sim::World({}));

  /// Looks at the surface in the 7^3 window around the voxel as far as it hangs together with the
  /// surface in the voxel or next to it. It is missing where no voxel of `occupied` holds it or
  /// lies half a voxel before or behind it.
  FalseEdgeCause causeOf(const VoxelIndex& edge, const BitGrid<16>& occupied, double voxel_size,
                         const Pose& T_world_grid) const;

 private:
  static constexpr int kReach = 3;  // of the window, voxels
  static constexpr int kWidth = 2 * kReach + 1;

  /// A point of the surface in one voxel of the window.
  struct SurfacePoint {
    bool there = false;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();   // just outside, world frame
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // outward
  };
  using Window = std::array<SurfacePoint, kWidth * kWidth * kWidth>;

  bool isOfMover(const Eigen::Vector3d& centre, double voxel_size) const;
  SurfacePoint surfaceNear(const Eigen::Vector3d& centre, double voxel_size) const;
  Window surfaceAround(const VoxelIndex& edge, double voxel_size, const Pose& T_world_grid) const;
  FalseEdgeCause causeOfMissing(const Eigen::Vector3d& point) const;
  bool isInView(const Eigen::Vector3d& in_sensor) const;

  const sim::World& world_;
  sim::Sensor sensor_;
  std::vector<Pose> T_world_sensor_;
  sim::World moved_;
};

}  // namespace edgevox
