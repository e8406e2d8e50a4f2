// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "core/compression.hpp"
#include "edgevox/map/plane_level.hpp"

namespace edgevox {

/// Whole numbers below 65536, the high bytes apart from the low ones.
struct Numbers16 {
  PackedBytes high;
  PackedBytes low;

  size_t size() const { return high.bytes.size(); }
  /// The nearest number in range.
  void add(double value);
  /// Throws ArchiveError if there are not as many.
  double number(size_t i) const;

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.high, self.low);
  }
};

/// Planes in a few bytes each. Normal: 0.15 degrees. Offset: 1/4096 voxel. Information: a fifth.
struct PlaneCode {
  std::array<Numbers16, 2> normal;
  Numbers16 offset;
  PackedBytes information;

  /// `size` [m]: of the voxel that the plane is in.
  void add(const Plane& plane, double size);
  /// The plane number i. Throws ArchiveError if there are not as many.
  Plane plane(size_t i, double size) const;

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.normal, self.offset, self.information);
  }
};

}  // namespace edgevox
