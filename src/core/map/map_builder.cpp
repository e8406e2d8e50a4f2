// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/map/map_builder.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/map/edge_children.hpp"

namespace edgevox {

MapBuilder::MapBuilder(double voxel_size, const MapConfig& map, const EdgeConfig& edges,
                       int threads, double max_range)
    : voxel_size_(voxel_size),
      max_range_(max_range),
      config_(map),
      labeller_(edges, edges.map, threads),
      edge_neighbours_(edges.mode == EdgeMode::kPaper ? 0 : edges.map_neighbours),
      lone_voxels_(map.confirm_within),
      moments_(2 * voxel_size),
      match_map_(voxel_size, map.coarsest_voxel) {}

void MapBuilder::insert(const std::vector<Eigen::Vector3d>& centroids,
                        const Eigen::Vector3d& sensor) {
  add(centroids, sensor);
  if (labelDue()) label();
}

void MapBuilder::add(const std::vector<Eigen::Vector3d>& centroids, const Eigen::Vector3d& sensor) {
  ++scans_;
  setPoints(centroids);
  leaveOutLone();
  freezeFar(sensor);
  full_ = usedBytes() >= memoryBytes();
  if (full_) leaveOutNew();
  for (const VoxelIndex& v : scan_.voxels) thawAround(v);
  addPoints(sensor);
}

void MapBuilder::setPoints(const std::vector<Eigen::Vector3d>& centroids) {
  scan_.centroids.clear();
  std::copy_if(centroids.begin(), centroids.end(), std::back_inserter(scan_.centroids),
               [this](const Eigen::Vector3d& c) { return inGridRange(c, voxel_size_); });
  ignored_ += centroids.size() - scan_.centroids.size();
  const double inverse_size = 1.0 / voxel_size_;
  scan_.voxels.resize(scan_.centroids.size());
  std::transform(scan_.centroids.begin(), scan_.centroids.end(), scan_.voxels.begin(),
                 [=](const Eigen::Vector3d& c) { return voxelAt(c, inverse_size); });
}

/// One pass a step: short loops over memory that do not wait for one another.
void MapBuilder::addPoints(const Eigen::Vector3d& sensor) {
  scan_.to_sensor.resize(scan_.centroids.size());
  scan_.slots.resize(scan_.centroids.size());
  std::transform(scan_.centroids.begin(), scan_.centroids.end(), scan_.to_sensor.begin(),
                 [&](const Eigen::Vector3d& c) -> Eigen::Vector3f {
                   return (sensor - c).cast<float>().normalized();
                 });
  addHits();
  addMoments();
  if (config_.clear_after > 0) clearSeenThrough(sensor);
  fitPlanes();
  moments_.updateSelected(match_map_.surfaces());
}

uint32_t MapBuilder::hitSlot(const VoxelIndex& v) {
  const uint32_t next = hit_slots_.next(Slots::kNear);
  const uint32_t slot = hit_grid_.insert(v, next);
  if (slot == next) hits_.hold(hit_slots_.take(Slots::kNear)) = {};
  return slot;
}

void MapBuilder::dropHit(uint32_t slot) {
  hits_.edit(slot) = {};
  hit_slots_.giveBack(slot);
  hit_slots_.dropIfFree(slot, hits_);
}

void MapBuilder::addHits() {
  for (size_t i = 0; i < scan_.voxels.size(); ++i) scan_.slots[i] = hitSlot(scan_.voxels[i]);
  for (size_t i = 0; i < scan_.voxels.size(); ++i) {
    Hit& hit = hits_.edit(scan_.slots[i]);
    const Eigen::Vector3f d =
        (scan_.centroids[i] - voxelCentre(scan_.voxels[i], voxel_size_)).cast<float>();
    for (size_t k = 0; k < 3; ++k) hit.sum[k] += d[static_cast<Eigen::Index>(k)];
    ++hit.count;
    if (hit.last_scan == scans_) continue;
    hit.last_scan = scans_;
    hit.passes = 0;
    if (++hit.hits == static_cast<uint32_t>(config_.min_hits)) {
      match_map_.hitVoxels().set(scan_.voxels[i]);
      changed_.set(scan_.voxels[i]);
    }
  }
}

void MapBuilder::addMoments() {
  SurfaceLevel& surfaces = match_map_.surfaces();
  for (size_t i = 0; i < scan_.voxels.size(); ++i) {
    const VoxelIndex v = coarser(scan_.voxels[i], 1);
    scan_.slots[i] = moments_.slotFor(v, surfaces);
    if (moments_.cell(scan_.slots[i]).hits != 0) continue;
    markOccupied(v);
    if (thawed_count_ == 0) continue;
    moments_.editCell(scan_.slots[i]).edge_children = edgeChildrenOf(edgeVoxels(), v);
  }
  for (size_t i = 0; i < scan_.voxels.size(); ++i) {
    if (!moments_.add(scan_.slots[i], scan_.centroids[i], scan_.to_sensor[i], scans_, surfaces))
      continue;
    touch(scan_.slots[i]);
    if (moments_.cell(scan_.slots[i]).hits == config_.min_hits) selectNew(scan_.slots[i]);
  }
}

void MapBuilder::markOccupied(const VoxelIndex& v) {
  for (int l = 1; l < levels(); ++l) {
    if (!match_map_.occupied(l).set(coarser(v, l - 1))) return;
  }
}

void MapBuilder::prepareAll() { moments_.updateAll(match_map_.surfaces()); }

void MapBuilder::clear() {
  scans_ = 0;
  ignored_ = 0;
  cleared_count_ = 0;
  left_out_lone_ = 0;
  left_out_full_ = 0;
  thawed_count_ = 0;
  full_ = false;
  lone_voxels_.clear();
  scan_.neighbours = {};
  hit_grid_ = {};
  hits_ = {};
  hit_slots_ = {};
  edge_candidates_ = {};
  changed_ = {};
  touched_ = std::vector<uint32_t>();  // which gives its memory back, unlike {}
  random_share_ = 0.0;
  match_map_ = MatchMap(voxel_size_, config_.coarsest_voxel);
  far_ = {};
  moments_ = MomentLevel(voxelSize(1));
}

Eigen::Vector3d MapBuilder::centroid(const VoxelIndex& v) const {
  const uint32_t slot = hit_grid_.find(v);
  return slot == SlotGrid<8>::kNone ? frozenCentroid(v) : centroidOf(slot, v);
}

Eigen::Vector3d MapBuilder::centroidOf(uint32_t slot, const VoxelIndex& v) const {
  const Hit& hit = hits_[slot];
  const Eigen::Vector3d sum(hit.sum[0], hit.sum[1], hit.sum[2]);
  return voxelCentre(v, voxel_size_) + sum / static_cast<double>(hit.count);
}

size_t MapBuilder::bytes() const {
  return hit_grid_.bytes() + hits_.bytes() + hit_slots_.bytes() + edge_candidates_.bytes() +
         changed_.bytes() + match_map_.bytes() + lone_voxels_.bytes() + scan_.neighbours.bytes() +
         far_.bytes() + moments_.bytes() + touched_.capacity() * sizeof(uint32_t);
}

size_t MapBuilder::usedBytes() const {
  const size_t free_cells = match_map_.surfaces().slots().freeCount(Slots::kNear);
  return bytes() - hit_grid_.freeBytes() - hit_slots_.freeCount(Slots::kNear) * sizeof(Hit) -
         edge_candidates_.freeBytes() - match_map_.freeBytes() -
         free_cells * MomentLevel::kCellBytes;
}

std::string fullText(const MapConfig& config) {
  return "the map has reached map/memory, " + std::to_string(config.memory) + " MB" +
         (config.freeze_after > 0 ? ", and what lies far off is frozen already" : "") +
         ": new places are not added; choose a larger voxel_size or a smaller "
         "voxelizer/max_range, or, with memory to spare, a larger map/memory";
}

std::vector<Eigen::Vector3f> centroidsOf(const MapBuilder& map, const BitGrid<16>& voxels) {
  std::vector<VoxelIndex> indices;
  voxels.forEach([&](const VoxelIndex& v) { indices.push_back(v); });
  std::sort(indices.begin(), indices.end());
  std::vector<Eigen::Vector3f> points(indices.size());
  std::transform(indices.begin(), indices.end(), points.begin(), [&](const VoxelIndex& v) {
    return Eigen::Vector3f(map.centroid(v).cast<float>());
  });
  return points;
}

}  // namespace edgevox
