// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/map/map_union.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "core/map/voxel_tree.hpp"
#include "edgevox/edges/edge_direction.hpp"

namespace edgevox {
namespace {

template <int kSide>
void addVoxels(const BitGrid<kSide>& from, BitGrid<kSide>& to) {
  from.forEach([&](const VoxelIndex& v) { to.set(v); });
}

/// The surfaces of selected voxels where `to` has selected none.
void addSurfaces(const SurfaceLevel& from, const std::vector<VoxelIndex>& occupied,
                 SurfaceLevel& to) {
  for (const VoxelIndex& v : occupied) {
    if (!from.isSelected(v) || to.isSelected(v)) continue;
    if (to.slotOf(v) != SurfaceLevel::kNone) to.erase(v);
    const Surface& front = from.surface(from.slotOf(v));
    const uint32_t slot = to.insert(v);
    to.editSurface(slot) = front;
    to.editSurface(slot).back_surface = Surface::kNone;
    to.setSelected(v, true);
    if (front.back_surface == Surface::kNone) continue;
    const uint32_t back = to.insertBack(slot);
    to.editSurface(back) = from.surface(front.back_surface);
  }
}

/// The planes of voxels where `to` has none.
void addPlanes(const PlaneLevel& from, PlaneLevel& to) {
  from.forEachVoxel([&](const VoxelIndex& v, const VoxelPlanes& planes) {
    if (to.find(v) == nullptr) to.set(v, planes);
  });
}

/// Points in the order of the tree, of which those of `a` stay.
template <typename Point>
std::vector<Point> together(const std::vector<Point>& a, const std::vector<Point>& b) {
  std::vector<Point> all;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all),
                 [](const Point& p, const Point& q) { return isBeforeInTree(p.voxel, q.voxel); });
  return all;
}

void setDirections(const BitGrid<16>& occupied, std::vector<EdgeVoxel>& edges) {
  std::vector<VoxelIndex> voxels;
  for (const EdgeVoxel& edge : edges) voxels.push_back(edge.voxel);
  const std::vector<Eigen::Vector3f> directions = edgeDirections(occupied, voxels);
  for (size_t i = 0; i < edges.size(); ++i) edges[i].direction = directions[i];
}

std::vector<VoxelPoint> pointsAt(const std::vector<VoxelIndex>& voxels,
                                 const std::vector<VoxelPoint>& known, double voxel_size) {
  std::vector<VoxelPoint> points;
  auto next = known.begin();
  for (const VoxelIndex& v : voxels) {
    while (next != known.end() && isBeforeInTree(next->voxel, v)) ++next;
    if (next != known.end() && next->voxel == v) {
      points.push_back(*next);
    } else {
      points.push_back({v, voxelCentre(v, voxel_size).cast<float>()});
    }
  }
  return points;
}

}  // namespace

MatchMap unionOf(const MatchMap& a, const MatchMap& b, Representation representation) {
  if (a.voxelSize(0) != b.voxelSize(0) || a.levels() != b.levels()) {
    throw std::invalid_argument("the maps have voxels of different sizes");
  }
  MatchMap map = a;
  addVoxels(b.hitVoxels(), map.hitVoxels());
  addVoxels(b.edgeVoxels(), map.edgeVoxels());
  for (int l = 1; l < b.levels(); ++l) addVoxels(b.occupied(l), map.occupied(l));
  addSurfaces(b.surfaces(), inTreeOrder(b.occupied(1)), map.surfaces());
  for (int l = MatchMap::kFinestPlanes; l <= MatchMap::kCoarsestPlanes; ++l) {
    addPlanes(b.planes(l), map.planes(l));
  }
  map.edges() = together(a.edges(), b.edges());
  setDirections(map.hitVoxels(), map.edges());
  map.besideEdges().clear();
  if (representation == Representation::kEdges) {
    map.besideEdges() = pointsAt(besideEdges(map.hitVoxels(), map.edgeVoxels()),
                                 together(a.besideEdges(), b.besideEdges()), map.voxelSize(0));
  }
  return map;
}

}  // namespace edgevox
