// SPDX-License-Identifier: BSD-3-Clause
// Sets of voxels as sorted lists, and their comparison.
#pragma once

#include <algorithm>
#include <iterator>
#include <vector>

#include <gtest/gtest.h>

#include "edgevox/grid/block_grid.hpp"
#include "edgevox/grid/voxel.hpp"

namespace edgevox::test {

/// Ascending, each voxel once.
using Voxels = std::vector<VoxelIndex>;

inline Voxels sorted(Voxels voxels) {
  std::sort(voxels.begin(), voxels.end());
  voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
  return voxels;
}

template <int kSide>
BitGrid<kSide> gridOf(const Voxels& voxels) {
  BitGrid<kSide> grid;
  for (const VoxelIndex& v : voxels) grid.set(v);
  return grid;
}

template <int kSide>
Voxels voxelsOf(const BitGrid<kSide>& grid) {
  Voxels voxels;
  grid.forEach([&](const VoxelIndex& v) { voxels.push_back(v); });
  std::sort(voxels.begin(), voxels.end());
  return voxels;
}

inline VoxelIndex operator+(const VoxelIndex& a, const VoxelIndex& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

inline Voxels translated(Voxels voxels, const VoxelIndex& by) {
  for (VoxelIndex& v : voxels) v = v + by;
  return voxels;
}

inline Voxels difference(const Voxels& a, const Voxels& b) {
  Voxels only_a;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(only_a));
  return only_a;
}

/// On failure says how many voxels differ and names the first.
inline ::testing::AssertionResult sameVoxels(const Voxels& expected, const Voxels& actual) {
  const Voxels missing = difference(expected, actual);
  const Voxels extra = difference(actual, expected);
  if (missing.empty() && extra.empty()) return ::testing::AssertionSuccess();
  const VoxelIndex& first = missing.empty() ? extra.front() : missing.front();
  return ::testing::AssertionFailure()
         << missing.size() << " of " << expected.size() << " voxels missing, " << extra.size()
         << " too many; the first: " << first.x << " " << first.y << " " << first.z;
}

}  // namespace edgevox::test
