// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "edgevox/grid/block_grid.hpp"
#include "edgevox/grid/voxel.hpp"

namespace edgevox {

/// A box of voxels, both corners in it; empty if the last is before the first.
struct VoxelBox {
  VoxelIndex first;
  VoxelIndex last{-1, -1, -1};

  bool empty() const { return last.x < first.x || last.y < first.y || last.z < first.z; }
  bool holds(const VoxelIndex& v) const {
    return v.x >= first.x && v.y >= first.y && v.z >= first.z && v.x <= last.x && v.y <= last.y &&
           v.z <= last.z;
  }
};
/// Of the voxels of a grid.
VoxelBox boxOf(const BitGrid<8>& grid);
/// What two boxes share.
VoxelBox common(const VoxelBox& a, const VoxelBox& b);

/// Occupied voxels as dense bits of cells, two a voxel's side, and their maxima over shifts: a cell
/// is set at height h if one of the cube of 2^h cells a side that begins with it is set at height
/// 0. So the points of a scan that hit at height h are at least as many as hit at height 0 after
/// any shift by 0 to 2^h - 1 cells along each axis.
class ShiftPyramid {
 public:
  /// `height` is the greatest.
  ShiftPyramid(const BitGrid<8>& occupied, int height);

  int height() const { return static_cast<int>(levels_.size()) - 1; }
  /// Of the cells that are set at height 0.
  const VoxelBox& box() const { return box_; }

  /// The number of `points`, in cells, that hit after a shift, or any number less than `least` if
  /// that is not reached.
  int hits(int height, const std::vector<VoxelIndex>& points, const VoxelIndex& shift,
           int least) const;

  size_t bytes() const { return levels_.size() * shape_.words() * sizeof(uint64_t); }
  /// Of such a pyramid of the voxels in a box.
  static size_t bytes(const VoxelBox& voxels, int height);

 private:
  using Words = std::vector<uint64_t>;

  struct Shape {
    VoxelIndex origin;
    std::array<size_t, 3> cells{};
    size_t words_a_row = 0;
    size_t words() const { return words_a_row * cells[1] * cells[2]; }
  };
  static VoxelBox cellsOf(const VoxelBox& voxels);
  static Shape shapeOf(const VoxelBox& cells, int height);
  Words maximaOver(const Words& words, int shift) const;

  VoxelBox box_;
  Shape shape_;
  std::vector<Words> levels_;
};

}  // namespace edgevox
