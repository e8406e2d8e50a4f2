// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/labelled_voxels.hpp"

#include "evaluation/placed_scan.hpp"
#include "evaluation/share.hpp"

namespace edgevox {
namespace {

/// The 27 voxels of a neighbourhood, itself first.
template <typename Visit>
bool anyOfNeighbourhood(const VoxelIndex& v, const Visit& visit) {
  if (visit(v)) return true;
  for (int32_t z = v.z - 1; z <= v.z + 1; ++z) {
    for (int32_t y = v.y - 1; y <= v.y + 1; ++y) {
      for (int32_t x = v.x - 1; x <= v.x + 1; ++x) {
        if (visit(VoxelIndex{x, y, z})) return true;
      }
    }
  }
  return false;
}

bool isNear(const BitGrid<16>& grid, const VoxelIndex& v) {
  return anyOfNeighbourhood(v, [&](const VoxelIndex& n) { return grid.test(n); });
}

}  // namespace

LabelledVoxels labelledVoxels(const Recording& recording, size_t scan, const VoxelScan& voxels) {
  LabelledVoxels labelled;
  labelled.voxel_size = 2.0 * voxels.voxel_size;
  labelled.T_map_grid = recording.scans[scan].T_map_sensor;
  SlotGrid<8> slots;
  std::vector<double> points;
  for (const ScanVoxel& part : voxels.voxels) {
    const VoxelIndex index = coarser(part.index, 1);
    const uint32_t slot = slots.insert(index, static_cast<uint32_t>(points.size()));
    if (slot == points.size()) {
      labelled.voxels.push_back({index, Eigen::Vector3d::Zero(), 0.0, part.edge});
      points.push_back(0.0);
    }
    points[slot] += part.point_count;
    labelled.voxels[slot].time_offset += part.point_count * static_cast<double>(part.time_offset);
  }
  for (size_t i = 0; i < points.size(); ++i) {
    LabelledVoxel& voxel = labelled.voxels[i];
    voxel.time_offset /= points[i];
    voxel.centre =
        recording.poseAt(scan, voxel.time_offset) * voxelCentre(voxel.index, labelled.voxel_size);
    labelled.edges += voxel.edge ? 1 : 0;
  }
  return labelled;
}

LabelledVoxels labelledVoxels(const BitGrid<16>& occupied, const BitGrid<16>& edges,
                              double voxel_size, const Pose& T_map_grid) {
  LabelledVoxels labelled;
  labelled.voxel_size = voxel_size;
  labelled.T_map_grid = T_map_grid;
  occupied.forEach([&](const VoxelIndex& v) {
    const bool edge = edges.test(v);
    labelled.voxels.push_back({v, T_map_grid * voxelCentre(v, voxel_size), 0.0, edge});
    labelled.edges += edge ? 1 : 0;
  });
  return labelled;
}

LabelledVoxels labelledVoxels(const MapBuilder& map, const Pose& T_map_grid) {
  return labelledVoxels(map.hitVoxels(), map.edgeVoxels(), map.voxelSize(0), T_map_grid);
}

std::vector<Eigen::Vector3d> placedCentroids(const Recording& recording, size_t scan,
                                             const VoxelScan& voxels) {
  return placedCentroids(voxels,
                         [&](double time_offset) { return recording.poseAt(scan, time_offset); });
}

Cells cellsOf(const LabelledVoxels& voxels, const Pose& T_map_grid) {
  const Pose T_grid_map = T_map_grid.inverse();
  Cells cells;
  for (const LabelledVoxel& voxel : voxels.voxels) {
    const VoxelIndex cell = voxelAt(T_grid_map * voxel.centre, 1.0 / voxels.voxel_size);
    cells.occupied.set(cell);
    if (voxel.edge) cells.edges.set(cell);
  }
  return cells;
}

double Agreement::edgeShare() const { return shareOf(edges_again, edges); }
double Agreement::otherShare() const { return shareOf(others_again, others); }

Agreement& Agreement::operator+=(const Agreement& more) {
  edges += more.edges;
  edges_again += more.edges_again;
  others += more.others;
  others_again += more.others_again;
  return *this;
}

Agreement agreement(const LabelledVoxels& voxels, const Cells& cells, const Pose& T_map_grid) {
  const Pose T_grid_map = T_map_grid.inverse();
  Agreement sum;
  for (const LabelledVoxel& voxel : voxels.voxels) {
    const VoxelIndex cell = voxelAt(T_grid_map * voxel.centre, 1.0 / voxels.voxel_size);
    if (!isNear(cells.occupied, cell)) continue;
    const size_t again = isNear(cells.edges, cell) ? 1 : 0;
    (voxel.edge ? sum.edges : sum.others) += 1;
    (voxel.edge ? sum.edges_again : sum.others_again) += again;
  }
  return sum;
}

double Recall::share() const { return shareOf(labelled, occupied); }

Recall& Recall::operator+=(const Recall& more) {
  occupied += more.occupied;
  labelled += more.labelled;
  return *this;
}

Recall recallOf(const LabelledVoxels& scan, const BitGrid<16>& map_edges) {
  const Cells cells = cellsOf(scan, Pose::Identity());
  BitGrid<16> occupied;
  BitGrid<16> labelled;
  const auto mark = [&](const VoxelIndex& cell, BitGrid<16>& marked) {
    anyOfNeighbourhood(cell, [&](const VoxelIndex& n) {
      if (map_edges.test(n)) marked.set(n);
      return false;
    });
  };
  cells.occupied.forEach([&](const VoxelIndex& cell) { mark(cell, occupied); });
  cells.edges.forEach([&](const VoxelIndex& cell) { mark(cell, labelled); });
  return {occupied.voxelCount(), labelled.voxelCount()};
}

}  // namespace edgevox
