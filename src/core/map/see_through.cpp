// SPDX-License-Identifier: BSD-3-Clause
// Voxels that later scans see through leave the map.
#include <algorithm>
#include <cmath>

#include "core/grid/ray_traversal.hpp"
#include "edgevox/map/map_builder.hpp"

namespace edgevox {
namespace {

constexpr size_t kLines = 8000;  // of sight a scan, in turn: bounds the time
constexpr double kNear = 0.25;   // of a line from the centroid of a voxel it sees through [voxel]
constexpr double kBehind = 1.0;  // of its end behind the surface [voxel]
constexpr double kBehindRough = 2.0;  // the same where the surface is not flat

template <typename Test>
bool anyChild(const VoxelIndex& v, const Test& test) {
  for (int i = 0; i < kChildren; ++i) {
    if (test(childOf(v, i))) return true;
  }
  return false;
}

}  // namespace

struct MapBuilder::Ray {
  Eigen::Vector3d sensor;
  Eigen::Vector3d end;
  double length;
  Eigen::Vector3d direction;

  Ray(const Eigen::Vector3d& from, const Eigen::Vector3d& to)
      : sensor(from), end(to), length((to - from).norm()), direction((to - from) / length) {}

  /// Whether the line passes within `near` of `point` and ends `behind` or more behind it.
  bool passes(const Eigen::Vector3d& point, double near, double behind) const {
    const Eigen::Vector3d to_point = point - sensor;
    const double along = to_point.dot(direction);
    return along > 0 && length - along >= behind &&
           to_point.squaredNorm() - along * along <= near * near;
  }

  /// Whether it crosses the plane and ends `behind` or more behind it.
  bool crosses(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double behind) const {
    const double before = normal.dot(sensor - point);
    const double after = normal.dot(end - point);
    return before * after < 0 && std::abs(after) >= behind;
  }
};

void MapBuilder::clearSeenThrough(const Eigen::Vector3d& sensor) {
  const double inverse_size = 1.0 / voxelSize(1);
  const size_t stride = 1 + scan_.centroids.size() / (kLines + 1);
  scan_.cleared.clear();
  for (size_t i = scans_ % stride; i < scan_.centroids.size(); i += stride) {
    const Ray ray(sensor, scan_.centroids[i]);
    const double reach = ray.length - kBehind * voxel_size_;
    if (!(reach > 0)) continue;
    forEachOnRay(match_map_.occupied(1), sensor * inverse_size,
                 (sensor + reach * ray.direction) * inverse_size,
                 [&](const VoxelIndex& parent) { lookThrough(ray, parent); });
  }
  for (const VoxelIndex& v : scan_.cleared) remove(v);
}

/// What lies in frozen regions is left alone: they are out of reach.
void MapBuilder::lookThrough(const Ray& ray, const VoxelIndex& parent) {
  const int32_t block = hit_grid_.findBlock(coarser(parent, 2));
  if (block == BlockTable::kNone) return;
  const uint32_t parent_slot = match_map_.surfaces().slotOf(parent);
  const bool known = parent_slot != SurfaceLevel::kNone;  // else thawed and not hit again
  if (known && moments_.cell(parent_slot).last_scan == scans_)
    return;  // then all its children are hit or beside
  for (int i = 0; i < kChildren; ++i) {
    const VoxelIndex v = childOf(parent, i);
    const uint32_t slot = SlotGrid<8>::slotIn(hit_grid_.block(static_cast<size_t>(block)), v);
    if (slot == SlotGrid<8>::kNone || hits_[slot].last_pass == scans_) continue;
    if (!isSeenThrough(ray, parent_slot, centroidOf(slot, v)) || isHitBeside(v)) continue;
    Hit& hit = hits_.edit(slot);
    hit.last_pass = scans_;
    if (++hit.passes == static_cast<uint32_t>(config_.clear_after)) scan_.cleared.push_back(v);
  }
}

/// Lines that graze a surface pass its voxels, too, and noise lifts points off it: neither ends
/// far behind the surface.
bool MapBuilder::isSeenThrough(const Ray& ray, uint32_t parent_slot,
                               const Eigen::Vector3d& point) const {
  if (!ray.passes(point, kNear * voxel_size_, kBehind * voxel_size_)) return false;
  const Eigen::Vector3d normal =
      parent_slot == SurfaceLevel::kNone ? Eigen::Vector3d::Zero() : moments_.normal(parent_slot);
  return normal.isZero() ? ray.passes(point, kNear * voxel_size_, kBehindRough * voxel_size_)
                         : ray.crosses(point, normal, kBehind * voxel_size_);
}

/// Whether this scan hit one of the 26 neighbours.
bool MapBuilder::isHitBeside(const VoxelIndex& v) const {
  for (int i = 0; i < 27; ++i) {
    const uint32_t slot = hit_grid_.find({v.x + i % 3 - 1, v.y + i / 3 % 3 - 1, v.z + i / 9 - 1});
    if (slot != SlotGrid<8>::kNone && hits_[slot].last_scan == scans_) return true;
  }
  return false;
}

void MapBuilder::remove(const VoxelIndex& v) {
  thawAround(v);
  if (match_map_.hitVoxels().reset(v)) {
    changed_.set(v);
    ++cleared_count_;
  }
  edge_candidates_.reset(v);
  if (match_map_.edgeVoxels().reset(v)) countEdges(coarser(v, 1));
  SurfaceLevel& surfaces = match_map_.surfaces();
  const uint32_t slot = surfaces.slotOf(coarser(v, 1));
  if (slot != SurfaceLevel::kNone) touch(slot);
  subtractMoments(v);
  dropHit(hit_grid_.find(v));
  hit_grid_.erase(v);
  VoxelIndex at = coarser(v, 1);
  bool left = anyChild(at, [&](const VoxelIndex& c) { return isHit(c); });
  if (!left && slot != SurfaceLevel::kNone) moments_.erase(at, surfaces);
  for (int l = 1; !left; ++l) {
    BitGrid<8>& bits = match_map_.occupied(l);
    bits.reset(at);
    if (l + 1 == levels()) return;
    at = coarser(at, 1);
    left = anyChild(at, [&](const VoxelIndex& c) { return bits.test(c); });
  }
}

/// Takes the points of a voxel out of the coarser one, which gets the sums over what is left: a
/// difference of large sums would be mostly rounding. How the points of a voxel scatter is not
/// kept; those left are taken for their share of what scatters within all voxels of the coarser
/// one. One with two sides stays as it is: of which the points were is not known.
void MapBuilder::subtractMoments(const VoxelIndex& v) {
  const VoxelIndex parent = coarser(v, 1);
  const Eigen::Vector3d origin = voxelCentre(parent, voxelSize(1));
  const uint32_t slot = match_map_.surfaces().slotOf(parent);
  if (slot == SurfaceLevel::kNone || match_map_.surfaces().hasBack(slot)) return;
  Moments all;
  Moments left;
  for (int i = 0; i < kChildren; ++i) {
    const VoxelIndex c = childOf(parent, i);
    if (!isHit(c)) continue;
    const Moments of_child = Moments::at(centroid(c) - origin, hits_[hit_grid_.find(c)].count);
    all += of_child;
    if (c != v) left += of_child;
  }
  if (all.count != moments_.cell(slot).count) return;  // thawed: not all is known of its children
  left.outer += left.count / all.count * (moments_.moments(slot).outer - all.outer);
  moments_.setMoments(slot, left);
}

}  // namespace edgevox
