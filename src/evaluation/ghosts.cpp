// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/ghosts.hpp"

#include <algorithm>

namespace edgevox {
namespace {

constexpr double kMoverReach = 1.0;  // voxels
constexpr double kStillReach = 1.5;  // the same

}  // namespace

GhostJudge::GhostJudge(const SimulatedTruth& truth, double begin, double end)
    : still_(truth.world),
      moved_(sim::volumeOf(truth.movers, begin, end)),
      left_(sim::solidsAt(truth.movers, end)) {}

bool GhostJudge::isGhost(const Eigen::Vector3d& centroid, double voxel_size) const {
  const double near = kMoverReach * voxel_size;
  const double far = kStillReach * voxel_size;
  const double limit = far + voxel_size;
  return moved_.clearance(centroid, limit) <= near && still_.clearance(centroid, limit) > far &&
         left_.clearance(centroid, limit) > far;
}

size_t GhostJudge::count(const std::vector<Eigen::Vector3f>& centroids, double voxel_size,
                         const Pose& T_world_grid) const {
  const auto ghosts =
      std::count_if(centroids.begin(), centroids.end(), [&](const Eigen::Vector3f& centroid) {
        return isGhost(T_world_grid * centroid.cast<double>(), voxel_size);
      });
  return static_cast<size_t>(ghosts);
}

}  // namespace edgevox
