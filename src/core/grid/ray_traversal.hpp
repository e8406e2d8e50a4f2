// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include <Eigen/Core>

#include "edgevox/grid/block_grid.hpp"

namespace edgevox {

/// Walks along a line from voxel to voxel (Amanatides and Woo 1987).
class RayTraversal {
 public:
  /// A line between two ends in voxels: voxel v holds v to v + 1.
  RayTraversal(const Eigen::Vector3d& from, const Eigen::Vector3d& to) : at_(voxelAt(from, 1.0)) {
    const VoxelIndex last = voxelAt(to, 1.0);
    left_ = std::abs(last.x - at_.x) + std::abs(last.y - at_.y) + std::abs(last.z - at_.z);
    const Eigen::Vector3d line = to - from;
    const int32_t start[3] = {at_.x, at_.y, at_.z};
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      step_[axis] = line[axis] < 0 ? -1 : 1;
      pitch_[axis] = std::abs(1.0 / line[axis]);
      const double border = start[axis] + (line[axis] < 0 ? 0.0 : 1.0);
      const double to_border = std::abs(border - from[axis]);
      next_[axis] =
          line[axis] == 0.0 ? std::numeric_limits<double>::infinity() : to_border * pitch_[axis];
    }
  }

  const VoxelIndex& at() const { return at_; }

  /// Goes to the next voxel; false at the end of the line.
  bool advance() {
    if (left_-- == 0) return false;
    if (next_[0] < next_[1] && next_[0] < next_[2]) {
      at_.x += pass(0);
    } else if (next_[1] < next_[2]) {
      at_.y += pass(1);
    } else {
      at_.z += pass(2);
    }
    return true;
  }

 private:
  int pass(Eigen::Index axis) {
    next_[axis] += pitch_[axis];
    return step_[axis];
  }

  VoxelIndex at_;
  int32_t left_;           // voxels to go
  Eigen::Vector3i step_;   // along each axis
  Eigen::Vector3d next_;   // where the next border of each axis is, the end of the line at 1
  Eigen::Vector3d pitch_;  // from one border to the next
};

/// Calls visit(VoxelIndex) for the voxels of `grid` on the way, in order. Both ends in its voxels.
template <int kSide, typename Visit>
void forEachOnRay(const BitGrid<kSide>& grid, const Eigen::Vector3d& from,
                  const Eigen::Vector3d& to, Visit&& visit) {
  using Layout = BlockLayout<kSide>;
  RayTraversal walk(from, to);
  VoxelIndex block = Layout::block(walk.at());
  const auto* bits = grid.findBlock(block);
  do {
    const VoxelIndex& v = walk.at();
    if (Layout::block(v) != block) {
      block = Layout::block(v);
      bits = grid.findBlock(block);
    }
    if (bits != nullptr && Layout::test(*bits, v)) visit(v);
  } while (walk.advance());
}

}  // namespace edgevox
