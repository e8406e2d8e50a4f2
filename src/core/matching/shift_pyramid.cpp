// SPDX-License-Identifier: BSD-3-Clause
#include "core/matching/shift_pyramid.hpp"

#include <algorithm>

namespace edgevox {
namespace {

constexpr int kWordBits = 64;
constexpr size_t kLook = 16;  // points between two looks at whether it is worth while

VoxelIndex smallest(const VoxelIndex& a, const VoxelIndex& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}

VoxelIndex largest(const VoxelIndex& a, const VoxelIndex& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

}  // namespace

VoxelBox boxOf(const BitGrid<8>& grid) {
  VoxelBox box;
  grid.forEach([&](const VoxelIndex& v) {
    box = box.empty() ? VoxelBox{v, v} : VoxelBox{smallest(box.first, v), largest(box.last, v)};
  });
  return box;
}

VoxelBox common(const VoxelBox& a, const VoxelBox& b) {
  return {largest(a.first, b.first), smallest(a.last, b.last)};
}

VoxelBox ShiftPyramid::cellsOf(const VoxelBox& voxels) {
  if (voxels.empty()) return {};
  return {childOf(voxels.first, 0), childOf(voxels.last, kChildren - 1)};
}

/// Before the first cell there is room for those whose maxima reach it.
ShiftPyramid::Shape ShiftPyramid::shapeOf(const VoxelBox& cells, int height) {
  Shape shape;
  if (cells.empty()) return shape;
  const int before = (1 << height) - 1;
  const VoxelIndex& first = cells.first;
  const VoxelIndex& last = cells.last;
  shape.origin = {first.x - before, first.y - before, first.z - before};
  const auto count = [](int from, int to) { return static_cast<size_t>(to - from + 1); };
  shape.cells = {count(shape.origin.x, last.x), count(shape.origin.y, last.y),
                 count(shape.origin.z, last.z)};
  shape.words_a_row = (shape.cells[0] + kWordBits - 1) / kWordBits;
  return shape;
}

size_t ShiftPyramid::bytes(const VoxelBox& voxels, int height) {
  const Shape shape = shapeOf(cellsOf(voxels), height);
  return static_cast<size_t>(height + 1) * shape.words() * sizeof(uint64_t);
}

ShiftPyramid::ShiftPyramid(const BitGrid<8>& occupied, int height)
    : box_(cellsOf(boxOf(occupied))), shape_(shapeOf(box_, height)) {
  levels_.emplace_back(shape_.words());
  Words& cells = levels_.front();
  occupied.forEach([&](const VoxelIndex& voxel) {
    for (int i = 0; i < kChildren; ++i) {
      const VoxelIndex v = childOf(voxel, i);
      const auto x = static_cast<size_t>(v.x - shape_.origin.x);
      const auto y = static_cast<size_t>(v.y - shape_.origin.y);
      const auto z = static_cast<size_t>(v.z - shape_.origin.z);
      cells[(z * shape_.cells[1] + y) * shape_.words_a_row + x / kWordBits] |= uint64_t{1}
                                                                               << (x % kWordBits);
    }
  });
  for (int h = 0; h < height; ++h) levels_.push_back(maximaOver(levels_.back(), 1 << h));
}

/// Of each cell and that `shift` cells on, axis by axis.
ShiftPyramid::Words ShiftPyramid::maximaOver(const Words& words, int shift) const {
  Words out = words;
  const size_t row = shape_.words_a_row;
  const auto step = static_cast<size_t>(shift);
  const size_t whole = step / kWordBits;
  const size_t rest = step % kWordBits;
  for (size_t begin = 0; begin < out.size(); begin += row) {
    for (size_t w = 0; w + whole < row; ++w) {
      uint64_t moved = out[begin + w + whole] >> rest;
      if (rest != 0 && w + whole + 1 < row) {
        moved |= out[begin + w + whole + 1] << (kWordBits - rest);
      }
      out[begin + w] |= moved;
    }
  }
  const auto rows = [&](size_t stride, size_t length) {  // words apart, rows in a line of them
    const size_t line = stride * length;
    for (size_t begin = 0; begin < out.size(); begin += line) {
      for (size_t i = begin; i + step * stride < begin + line; ++i)
        out[i] |= out[i + step * stride];
    }
  };
  rows(row, shape_.cells[1]);
  rows(row * shape_.cells[1], shape_.cells[2]);
  return out;
}

int ShiftPyramid::hits(int height, const std::vector<VoxelIndex>& points, const VoxelIndex& shift,
                       int least) const {
  const Words& words = levels_[static_cast<size_t>(height)];
  const int dx = shift.x - shape_.origin.x;
  const int dy = shift.y - shape_.origin.y;
  const int dz = shift.z - shape_.origin.z;
  int missing = static_cast<int>(points.size()) - least;  // how many may still be
  int count = 0;
  for (size_t begin = 0; begin < points.size(); begin += kLook) {
    const size_t end = std::min(begin + kLook, points.size());
    int found = 0;
    for (size_t i = begin; i < end; ++i) {
      const auto x = static_cast<size_t>(points[i].x + dx);  // before the origin: huge
      const auto y = static_cast<size_t>(points[i].y + dy);
      const auto z = static_cast<size_t>(points[i].z + dz);
      if (x >= shape_.cells[0] || y >= shape_.cells[1] || z >= shape_.cells[2]) continue;
      const uint64_t word = words[(z * shape_.cells[1] + y) * shape_.words_a_row + x / kWordBits];
      found += static_cast<int>(word >> (x % kWordBits) & 1U);
    }
    count += found;
    missing -= static_cast<int>(end - begin) - found;
    if (missing < 0) return std::min(count, least - 1);
  }
  return count;
}

}  // namespace edgevox
