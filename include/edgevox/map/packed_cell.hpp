// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

namespace edgevox {

struct MomentCell;

/// A MomentCell in 16 bytes, for places out of reach. The mean of the centroids is that of its
/// surface; their covariance is kept to 6e-5 of the voxel's square, the mean view to 1/254, and of
/// more than 65535 centroids or 255 hits so many.
struct PackedCell {
  std::array<uint8_t, 2> count{};  ///< low byte first
  uint8_t hits = 0;
  uint8_t flags = 0;
  std::array<int8_t, 3> view{};         ///< mean [1 / 127]
  std::array<uint8_t, 9> covariance{};  ///< 12 bits each [voxel^2 / (4 * 2047)]

  PackedCell() = default;
  /// Of a voxel of `size` [m].
  PackedCell(const MomentCell& cell, double size);
  /// `mean`: of the centroids, from the voxel's centre [m]. Without edge_children; not stale, and
  /// not hit by any scan yet.
  MomentCell unpacked(const Eigen::Vector3d& mean, double size) const;
};
static_assert(sizeof(PackedCell) == 16, "as stored");

}  // namespace edgevox
