// SPDX-License-Identifier: BSD-3-Clause
#include "ros/live/map_snapshot.hpp"

#include <vector>

namespace edgevox {

MapSnapshot snapshotOf(const MapBuilder& map) {
  const auto copy = std::make_shared<const MapBuilder>(map);
  MapSnapshot snapshot;
  snapshot.voxel_size = copy->voxelSize(0);
  snapshot.edge_voxels = copy->edgeVoxels();
  snapshot.edge_centroids = [copy] { return centroidsOf(*copy, copy->edgeVoxels()); };
  snapshot.occupied_points = [copy] { return centroidsOf(*copy, copy->hitVoxels()); };
  return snapshot;
}

MapSnapshot snapshotOf(std::shared_ptr<const MatchMap> map) {
  MapSnapshot snapshot;
  snapshot.voxel_size = map->voxelSize(0);
  snapshot.edge_voxels = map->edgeVoxels();
  snapshot.edge_centroids = [map] {
    MapSnapshot::Points points;
    for (const EdgeVoxel& edge : map->edges()) points.push_back(edge.centroid);
    return points;
  };
  snapshot.occupied_points = [map] {
    MapSnapshot::Points points;
    map->hitVoxels().forEach([&](const VoxelIndex& v) {
      points.push_back(voxelCentre(v, map->voxelSize(0)).cast<float>());
    });
    return points;
  };
  return snapshot;
}

}  // namespace edgevox
