// SPDX-License-Identifier: BSD-3-Clause
#include "street_tile.hpp"

#include <set>

#include "edgevox/grid/voxel.hpp"

namespace edgevox::bench {
namespace {

// In voxels.
constexpr int kLength = 256;
constexpr int kWidth = 128;
constexpr int kHeight = 80;
constexpr int kColumns = 16;  // tiles side by side
constexpr int kFirst = 2048;  // where the street begins

using Voxels = std::set<VoxelIndex>;

/// The surface of the box from `low` up to, but without, `high`.
void addBox(const VoxelIndex& low, const VoxelIndex& high, Voxels& out) {
  for (int32_t z = low.z; z < high.z; ++z) {
    for (int32_t y = low.y; y < high.y; ++y) {
      const bool shell = z == low.z || z == high.z - 1 || y == low.y || y == high.y - 1;
      for (int32_t x = low.x; x < high.x; x += shell ? 1 : high.x - low.x - 1) {
        out.insert({x, y, z});
      }
    }
  }
}

/// A wall along x, with recessed windows.
void addFacade(int32_t y, int32_t recess, Voxels& out) {
  for (int32_t z = 0; z < kHeight; ++z) {
    for (int32_t x = 0; x < kLength; ++x) {
      const bool window = x % 32 >= 10 && x % 32 < 22 && z % 28 >= 10 && z % 28 < 24;
      out.insert({x, window ? y + recess : y, z});
    }
  }
}

Voxels piece() {
  Voxels voxels;
  for (int32_t y = 0; y < kWidth; ++y) {
    for (int32_t x = 0; x < kLength; ++x) voxels.insert({x, y, 0});
  }
  addFacade(0, 2, voxels);
  addFacade(kWidth - 1, -2, voxels);
  for (int32_t x = 20; x + 45 < kLength; x += 60) addBox({x, 12, 3}, {x + 42, 30, 18}, voxels);
  return voxels;
}

VoxelIndex cornerOf(int tile) {
  return {kFirst + (tile / kColumns) * (kLength + 16), (tile % kColumns) * (kWidth + 16), 0};
}

}  // namespace

std::vector<Eigen::Vector3d> streetTile(int tile, double voxel_size) {
  static const Voxels voxels = piece();
  const VoxelIndex at = cornerOf(tile);
  std::vector<Eigen::Vector3d> centres;
  for (const VoxelIndex& v : voxels) {
    centres.push_back(voxelCentre({at.x + v.x, at.y + v.y, at.z + v.z}, voxel_size));
  }
  return centres;
}

Eigen::Vector3d streetSensor(int tile, double voxel_size) {
  const VoxelIndex at = cornerOf(tile);
  return voxelCentre({at.x + kLength / 2, at.y + kWidth / 2, at.z + 17}, voxel_size);
}

}  // namespace edgevox::bench
