// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/map_code.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "core/compression.hpp"
#include "core/map/plane_code.hpp"
#include "core/map/surface_code.hpp"
#include "core/map/voxel_tree.hpp"
#include "edgevox/archive.hpp"
#include "edgevox/edges/edge_direction.hpp"
#include "edgevox/map/surface.hpp"

namespace edgevox {
namespace {

constexpr double kCentroidSteps = 16.0;  // a voxel

/// A bit a voxel, in their order.
struct Flags {
  PackedBytes bits;

  Flags() = default;
  template <typename Test>
  Flags(const std::vector<VoxelIndex>& voxels, const Test& test) {
    bits.bytes.resize((voxels.size() + 7) / 8);
    for (size_t i = 0; i < voxels.size(); ++i) {
      char& byte = bits.bytes[i / 8];
      if (test(voxels[i])) byte = static_cast<char>(byte | 1 << (i % 8));
    }
  }

  /// The voxels whose bit is set. Throws ArchiveError.
  std::vector<VoxelIndex> of(const std::vector<VoxelIndex>& voxels) const {
    if (bits.bytes.size() != (voxels.size() + 7) / 8) throw ArchiveError("flags are missing");
    std::vector<VoxelIndex> flagged;
    for (size_t i = 0; i < voxels.size(); ++i) {
      if (((bits.bytes[i / 8] >> (i % 8)) & 1) != 0) flagged.push_back(voxels[i]);
    }
    return flagged;
  }

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.bits);
  }
};

/// What some voxels have on one side or on both, by SurfaceCode or PlaneCode.
template <typename Code>
struct SidedCode {
  Flags known;      // of the occupied voxels
  Flags two_sided;  // of the known ones
  Code front;
  Code back;

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.known, self.two_sided, self.front, self.back);
  }
};

struct MapCode {
  VoxelTree hit;                         // voxels of level 0
  VoxelTree single;                      // occupied voxels of level 1 that hold none of these
  Flags edges;                           // of the hit voxels
  std::array<PackedBytes, 3> centroids;  // of the edges
  SidedCode<SurfaceCode> surfaces;  // of the selected voxels; none with the representation `edges`
  // With that: of the voxels beside edges, and which of those of level 1 that hold edges have no
  // surface in the file: two-sided ones, as centroids do not tell the sides apart.
  std::array<PackedBytes, 3> beside;
  Flags without_surface;
  std::vector<SidedCode<PlaneCode>> planes;  // from MatchMap::kFinestPlanes on

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.hit, self.single, self.edges, self.centroids, self.surfaces, self.beside,
          self.without_surface, self.planes);
  }
};

std::vector<VoxelIndex> parentsOf(const std::vector<VoxelIndex>& voxels) {
  std::vector<VoxelIndex> parents;
  for (const VoxelIndex& v : voxels) {
    const VoxelIndex parent = coarser(v, 1);
    if (parents.empty() || parents.back() != parent) parents.push_back(parent);
  }
  return parents;
}

void addSurfaces(const SurfaceLevel& level, const std::vector<VoxelIndex>& occupied,
                 SidedCode<SurfaceCode>& code) {
  code.known = Flags(occupied, [&](const VoxelIndex& v) { return level.isSelected(v); });
  const std::vector<VoxelIndex> selected = code.known.of(occupied);
  code.two_sided =
      Flags(selected, [&](const VoxelIndex& v) { return level.hasBack(level.slotOf(v)); });
  for (const VoxelIndex& v : selected) {
    const Surface& front = level.surface(level.slotOf(v));
    code.front.add(front, v, level.voxelSize());
    if (front.back_surface == SurfaceLevel::kNone) continue;
    code.back.add(level.surface(front.back_surface), v, level.voxelSize());
  }
}

void addPlanes(const PlaneLevel& level, const std::vector<VoxelIndex>& occupied,
               SidedCode<PlaneCode>& code) {
  code.known = Flags(occupied, [&](const VoxelIndex& v) { return level.find(v) != nullptr; });
  const std::vector<VoxelIndex> known = code.known.of(occupied);
  code.two_sided = Flags(known, [&](const VoxelIndex& v) { return level.find(v)->count == 2; });
  for (const VoxelIndex& v : known) {
    const VoxelPlanes& planes = *level.find(v);
    code.front.add(planes.sides[0], level.voxelSize());
    if (planes.count == 2) code.back.add(planes.sides[1], level.voxelSize());
  }
}

void makePlanes(const SidedCode<PlaneCode>& code, const std::vector<VoxelIndex>& occupied,
                PlaneLevel& level) {
  const std::vector<VoxelIndex> known = code.known.of(occupied);
  const std::vector<VoxelIndex> two_sided = code.two_sided.of(known);
  size_t backs = 0;
  for (size_t i = 0; i < known.size(); ++i) {
    VoxelPlanes planes;
    planes.add(code.front.plane(i, level.voxelSize()));
    if (backs < two_sided.size() && two_sided[backs] == known[i]) {
      planes.add(code.back.plane(backs++, level.voxelSize()));
    }
    level.set(known[i], planes);
  }
}

/// Keeps what the slots of a level say of back surfaces.
void setSurface(uint32_t slot, const Surface& surface, SurfaceLevel& level) {
  const uint32_t back = level.surface(slot).back_surface;
  level.editSurface(slot) = surface;
  level.editSurface(slot).back_surface = back;
}

void makeSurfaces(const SidedCode<SurfaceCode>& code, const std::vector<VoxelIndex>& occupied,
                  SurfaceLevel& level) {
  const std::vector<VoxelIndex> selected = code.known.of(occupied);
  const std::vector<VoxelIndex> two_sided = code.two_sided.of(selected);
  for (size_t i = 0; i < selected.size(); ++i) {
    setSurface(level.insert(selected[i]), code.front.surface(i, selected[i], level.voxelSize()),
               level);
    level.setSelected(selected[i], true);
  }
  for (size_t i = 0; i < two_sided.size(); ++i) {
    level.editSurface(level.insertBack(level.slotOf(two_sided[i]))) =
        code.back.surface(i, two_sided[i], level.voxelSize());
  }
}

/// The points of a coarser voxel follow one another.
void makeSurfaces(const std::vector<VoxelPoint>& points, const std::vector<VoxelIndex>& voxels,
                  SurfaceLevel& level) {
  auto next = voxels.begin();
  for (size_t i = 0; i < points.size();) {
    const VoxelIndex v = coarser(points[i].voxel, 1);
    const Eigen::Vector3d centre = voxelCentre(v, level.voxelSize());
    Moments moments;
    for (; i < points.size() && coarser(points[i].voxel, 1) == v; ++i) {
      addCentroid(points[i].centroid.cast<double>() - centre, moments);
    }
    if (next == voxels.end() || *next != v) continue;
    ++next;
    setSurface(level.insert(v), surfaceOfCentroids(moments, v, level.voxelSize()), level);
    level.setSelected(v, true);
  }
}

char stepOf(double in_voxel) {
  return static_cast<char>(
      std::min(std::max(std::floor(in_voxel * kCentroidSteps), 0.0), kCentroidSteps - 1));
}

template <typename Point>
void addCentroids(const std::vector<Point>& points, double size, std::array<PackedBytes, 3>& code) {
  for (const Point& point : points) {
    const VoxelIndex& v = point.voxel;
    const Eigen::Vector3d in_voxel =
        point.centroid.template cast<double>() / size - Eigen::Vector3d(v.x, v.y, v.z);
    for (size_t i = 0; i < code.size(); ++i) {
      code[i].bytes.push_back(stepOf(in_voxel[static_cast<Eigen::Index>(i)]));
    }
  }
}

std::vector<VoxelPoint> centroidsOf(const std::array<PackedBytes, 3>& code,
                                    const std::vector<VoxelIndex>& voxels, double size) {
  std::vector<VoxelPoint> points(voxels.size());
  for (size_t i = 0; i < points.size(); ++i) {
    Eigen::Vector3d steps;
    for (size_t axis = 0; axis < code.size(); ++axis) {
      const std::string& bytes = code[axis].bytes;
      if (bytes.size() != points.size()) throw ArchiveError("centroids are missing");
      steps[static_cast<Eigen::Index>(axis)] = static_cast<double>(bytes[i] & 15) + 0.5;
    }
    const VoxelIndex& v = voxels[i];
    const Eigen::Vector3d in_voxels = Eigen::Vector3d(v.x, v.y, v.z) + steps / kCentroidSteps;
    points[i] = {v, (size * in_voxels).cast<float>()};
  }
  return points;
}

std::vector<EdgeVoxel> edgesOf(const std::vector<VoxelPoint>& points,
                               const std::vector<VoxelIndex>& voxels, const BitGrid<16>& hit) {
  const std::vector<Eigen::Vector3f> directions = edgeDirections(hit, voxels);
  std::vector<EdgeVoxel> edges(points.size());
  for (size_t i = 0; i < edges.size(); ++i) {
    edges[i] = {points[i].voxel, points[i].centroid, directions[i]};
  }
  return edges;
}

std::vector<VoxelPoint> together(const std::vector<VoxelPoint>& a,
                                 const std::vector<VoxelPoint>& b) {
  std::vector<VoxelPoint> all;
  std::merge(
      a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all),
      [](const VoxelPoint& p, const VoxelPoint& q) { return isBeforeInTree(p.voxel, q.voxel); });
  return all;
}

std::vector<VoxelIndex> together(const std::vector<VoxelIndex>& a,
                                 const std::vector<VoxelIndex>& b) {
  std::vector<VoxelIndex> all;
  std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all), isBeforeInTree);
  return all;
}

std::vector<VoxelIndex> difference(const std::vector<VoxelIndex>& a,
                                   const std::vector<VoxelIndex>& b) {
  std::vector<VoxelIndex> left;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(left),
                      isBeforeInTree);
  return left;
}

void addEdgeSurfaces(const MatchMap& map, MapCode& code) {
  addCentroids(map.besideEdges(), map.voxelSize(0), code.beside);
  const std::vector<VoxelIndex> edges = inTreeOrder(map.edgeVoxels());
  const SurfaceLevel& level = map.surfaces();
  code.without_surface = Flags(parentsOf(edges), [&](const VoxelIndex& v) {
    return !level.isSelected(v) || level.hasBack(level.slotOf(v));
  });
}

void makeEdgeSurfaces(const MapCode& code, const std::vector<VoxelPoint>& edges, MatchMap& map) {
  map.besideEdges() =
      centroidsOf(code.beside, besideEdges(map.hitVoxels(), map.edgeVoxels()), map.voxelSize(0));
  const std::vector<VoxelPoint> points = together(edges, map.besideEdges());
  const std::vector<VoxelIndex> voxels = inTreeOrder(map.edgeVoxels());
  const std::vector<VoxelIndex> holding = parentsOf(voxels);
  makeSurfaces(points, difference(holding, code.without_surface.of(holding)), map.surfaces());
}

}  // namespace

std::string encoded(const MatchMap& map, Representation representation) {
  MapCode code;
  const std::vector<VoxelIndex> hit = inTreeOrder(map.hitVoxels());
  std::vector<VoxelIndex> occupied = inTreeOrder(map.occupied(1));
  code.hit = VoxelTree(hit);
  code.single = VoxelTree(difference(occupied, parentsOf(hit)));
  code.edges = Flags(hit, [&](const VoxelIndex& v) { return map.edgeVoxels().test(v); });
  addCentroids(map.edges(), map.voxelSize(0), code.centroids);
  if (representation == Representation::kEdges) addEdgeSurfaces(map, code);
  if (representation != Representation::kEdges) {
    addSurfaces(map.surfaces(), occupied, code.surfaces);
  }
  for (int l = MatchMap::kFinestPlanes; l <= MatchMap::kCoarsestPlanes; ++l) {
    occupied = parentsOf(occupied);
    addPlanes(map.planes(l), occupied, code.planes.emplace_back());
  }
  ArchiveWriter bytes;
  bytes(code);
  return bytes.take();
}

MatchMap decoded(const std::string& bytes, const Config& config) {
  MapCode code;
  ArchiveReader reader(bytes);
  reader(code);
  reader.requireEnd();
  const bool of_edges = config.map.representation == Representation::kEdges;
  if (code.planes.size() != MatchMap::kCoarsestPlanes - MatchMap::kFinestPlanes + 1) {
    throw ArchiveError("it lacks a level of planes");
  }
  MatchMap map(config.voxel_size, config.map.coarsest_voxel);
  const std::vector<VoxelIndex> hit = code.hit.voxels();
  for (const VoxelIndex& v : hit) map.hitVoxels().set(v);
  const std::vector<VoxelIndex> edges = code.edges.of(hit);
  for (const VoxelIndex& v : edges) map.edgeVoxels().set(v);
  const std::vector<VoxelPoint> points = centroidsOf(code.centroids, edges, config.voxel_size);
  map.edges() = edgesOf(points, edges, map.hitVoxels());
  if (of_edges) makeEdgeSurfaces(code, points, map);
  std::vector<VoxelIndex> occupied = together(parentsOf(hit), code.single.voxels());
  for (int l = 1; l < map.levels(); ++l) {
    for (const VoxelIndex& v : occupied) map.occupied(l).set(v);
    if (l == 1 && !of_edges) makeSurfaces(code.surfaces, occupied, map.surfaces());
    if (l >= MatchMap::kFinestPlanes && l <= MatchMap::kCoarsestPlanes) {
      makePlanes(code.planes[static_cast<size_t>(l - MatchMap::kFinestPlanes)], occupied,
                 map.planes(l));
    }
    occupied = parentsOf(occupied);
  }
  return map;
}

}  // namespace edgevox
