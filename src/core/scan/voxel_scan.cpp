// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/scan/voxel_scan.hpp"

#include <algorithm>
#include <utility>

#include "edgevox/grid/block_grid.hpp"

namespace edgevox {
namespace {

void add(const ScanVoxel& part, ScanVoxel& whole) {
  const uint32_t count = whole.point_count + part.point_count;
  const float share = static_cast<float>(part.point_count) / static_cast<float>(count);
  whole.centroid += share * (part.centroid - whole.centroid);
  whole.time_offset += share * (part.time_offset - whole.time_offset);
  whole.point_count = count;
  whole.edge = whole.edge || part.edge;
}

}  // namespace

VoxelScan inMapVoxels(const VoxelScan& scan) {
  VoxelScan coarse = scan;
  coarse.voxel_size = 2 * scan.voxel_size;
  coarse.voxels.clear();
  SlotGrid<8> positions;
  for (const ScanVoxel& voxel : scan.voxels) {
    const VoxelIndex index = coarser(voxel.index, 1);
    const auto next = static_cast<uint32_t>(coarse.voxels.size());
    const uint32_t position = positions.insert(index, next);
    if (position == next) {
      coarse.voxels.push_back(voxel);
      coarse.voxels.back().index = index;
    } else {
      add(voxel, coarse.voxels[position]);
    }
  }
  return coarse;
}

VoxelScan edgeVoxels(const VoxelScan& scan) {
  VoxelScan edges = inMapVoxels(scan);
  edges.voxels.erase(std::remove_if(edges.voxels.begin(), edges.voxels.end(),
                                    [](const ScanVoxel& voxel) { return !voxel.edge; }),
                     edges.voxels.end());
  return edges;
}

VoxelScan voxelsToMatch(VoxelScan scan, ScanVoxels chosen) {
  return chosen == ScanVoxels::kEdges ? edgeVoxels(scan) : std::move(scan);
}

}  // namespace edgevox
