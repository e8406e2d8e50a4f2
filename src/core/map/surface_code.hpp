// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "core/compression.hpp"
#include "edgevox/grid/voxel.hpp"
#include "edgevox/map/surface_level.hpp"

namespace edgevox {

/// Surfaces in a few bytes each, a string of bytes for each quantity, so that like stands beside
/// like. Mean: 1/64 voxel. Directions: a degree. Information: a tenth.
struct SurfaceCode {
  std::array<PackedBytes, 3> mean;
  std::array<PackedBytes, 2> normal;  ///< direction of the greatest information
  PackedBytes turn;                   ///< of the direction of the second greatest about it
  std::array<PackedBytes, 2> information;
  PackedBytes kind;                 ///< what Surface::side is
  std::array<PackedBytes, 2> view;  ///< where it is a direction of view

  size_t size() const { return kind.bytes.size(); }
  /// `v`: the voxel of `size` [m] that holds the surface.
  void add(const Surface& surface, const VoxelIndex& v, double size);
  /// The surface number i. Throws ArchiveError if there are not as many.
  Surface surface(size_t i, const VoxelIndex& v, double size) const;

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.mean, self.normal, self.turn, self.information, self.kind, self.view);
  }
};

}  // namespace edgevox
