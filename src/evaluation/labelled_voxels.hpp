// SPDX-License-Identifier: BSD-3-Clause
// Occupied voxels with their labels, of one scan or of the map, and how far two sets agree.
#pragma once

#include <cstddef>
#include <vector>

#include "edgevox/grid/block_grid.hpp"
#include "edgevox/grid/voxel.hpp"
#include "edgevox/map/map_builder.hpp"
#include "edgevox/scan/voxel_scan.hpp"
#include "evaluation/recording.hpp"

namespace edgevox {

struct LabelledVoxel {
  VoxelIndex index;          ///< in the grid that was labelled
  Eigen::Vector3d centre;    ///< deskewed, map frame [m]
  double time_offset = 0.0;  ///< of its points, from the stamp [s]
  bool edge = false;
};

/// Voxels of the map's size, each once.
struct LabelledVoxels {
  double voxel_size = 0.0;             ///< [m]
  Pose T_map_grid = Pose::Identity();  ///< of a scan: T_map_sensor at the stamp
  std::vector<LabelledVoxel> voxels;
  size_t edges = 0;

  size_t occupied() const { return voxels.size(); }
};

/// The voxels of scan number `scan` of the recording, voxelized at half the map's voxel and
/// labelled.
LabelledVoxels labelledVoxels(const Recording& recording, size_t scan, const VoxelScan& voxels);
/// The voxels of a grid that stands in the map.
LabelledVoxels labelledVoxels(const BitGrid<16>& occupied, const BitGrid<16>& edges,
                              double voxel_size, const Pose& T_map_grid);
/// The voxels with enough hits of a map in a grid of its own.
LabelledVoxels labelledVoxels(const MapBuilder& map, const Pose& T_map_grid);

/// Centroids of a scan, each at the pose of its time, map frame [m].
std::vector<Eigen::Vector3d> placedCentroids(const Recording& recording, size_t scan,
                                             const VoxelScan& voxels);

/// The voxels in which the centres lie in a grid of any frame.
struct Cells {
  BitGrid<16> occupied;
  BitGrid<16> edges;
};
Cells cellsOf(const LabelledVoxels& voxels, const Pose& T_map_grid);

/// Of the voxels of one set that lie in or next to an occupied cell of another, how many are in or
/// next to an edge cell of it.
struct Agreement {
  size_t edges = 0;
  size_t edges_again = 0;
  size_t others = 0;
  size_t others_again = 0;

  double edgeShare() const;   ///< NaN without edges
  double otherShare() const;  ///< NaN without others
  Agreement& operator+=(const Agreement& more);
};
/// `cells` is of a grid in the frame T_map_grid.
Agreement agreement(const LabelledVoxels& voxels, const Cells& cells, const Pose& T_map_grid);

/// Of the map's edges that a scan occupies, itself or a neighbour, those next to an edge of it.
struct Recall {
  size_t occupied = 0;
  size_t labelled = 0;

  double share() const;  ///< NaN without occupied ones
  Recall& operator+=(const Recall& more);
};
Recall recallOf(const LabelledVoxels& scan, const BitGrid<16>& map_edges);

}  // namespace edgevox
