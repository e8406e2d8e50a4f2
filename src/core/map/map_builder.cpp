// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/map/map_builder.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/grid/dilate.hpp"
#include "core/map/edge_children.hpp"
#include "core/sort_unique.hpp"

namespace edgevox {
namespace {

constexpr size_t kMegabyte = 1000000;
constexpr size_t kNoBlock = static_cast<size_t>(BlockTable::kNone);  // what was there is gone
constexpr double kNewShare = 0.25;  // of the voxels that came since the last choice of anchors

}  // namespace

MapBuilder::MapBuilder(double voxel_size, const MapConfig& map, const EdgeConfig& edges,
                       int threads, double max_range)
    : voxel_size_(voxel_size),
      max_range_(max_range),
      config_(map),
      labeller_(edges, edges.map, threads),
      edge_neighbours_(edges.mode == EdgeMode::kPaper ? 0 : edges.map_neighbours),
      lone_voxels_(map.confirm_within),
      match_map_(voxel_size, map.coarsest_voxel) {
  for (int l = 1; l <= MatchMap::kSurfaceLevels; ++l) moments_.emplace_back(voxelSize(l));
}

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
  full_ = usedBytes() >= static_cast<size_t>(config_.memory) * kMegabyte;
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

/// One pass a level and a step: short loops over memory that do not wait for one another.
void MapBuilder::addPoints(const Eigen::Vector3d& sensor) {
  scan_.to_sensor.resize(scan_.centroids.size());
  scan_.slots.resize(scan_.centroids.size());
  std::transform(scan_.centroids.begin(), scan_.centroids.end(), scan_.to_sensor.begin(),
                 [&](const Eigen::Vector3d& c) -> Eigen::Vector3f {
                   return (sensor - c).cast<float>().normalized();
                 });
  addHits();
  for (int l = 1; l <= MatchMap::kSurfaceLevels; ++l) addMoments(l);
  if (config_.clear_after > 0) clearSeenThrough(sensor);
  for (int l = 1; l <= MatchMap::kSurfaceLevels; ++l) {
    momentLevel(l).updateSelected(match_map_.surfaces(l));
  }
}

bool MapBuilder::labelDue() const {
  return config_.representation != Representation::kAll &&
         scans_ % static_cast<uint32_t>(config_.label_every) == 0;
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
      hit_voxels_.set(scan_.voxels[i]);
      changed_.set(scan_.voxels[i]);
    }
  }
}

void MapBuilder::addMoments(int l) {
  MomentLevel& level = momentLevel(l);
  SurfaceLevel& surfaces = match_map_.surfaces(l);
  for (size_t i = 0; i < scan_.voxels.size(); ++i) {
    const VoxelIndex v = coarser(scan_.voxels[i], l);
    scan_.slots[i] = level.slotFor(v, surfaces);
    if (level.cell(scan_.slots[i]).hits != 0) continue;
    if (l == 1) markOccupied(v);
    if (thawed_count_ == 0) continue;
    level.editCell(scan_.slots[i]).edge_children = edgeChildrenOf(edgeVoxels(), l, v);
  }
  for (size_t i = 0; i < scan_.voxels.size(); ++i) {
    if (!level.add(scan_.slots[i], scan_.centroids[i], scan_.to_sensor[i], scans_, surfaces))
      continue;
    touch(l, scan_.slots[i]);
    if (level.cell(scan_.slots[i]).hits == config_.min_hits) selectNew(l, scan_.slots[i]);
  }
}

void MapBuilder::selectNew(int l, uint32_t slot) {
  MomentLevel& level = momentLevel(l);
  if (config_.representation == Representation::kAll) select(l, slot, true);
  if (config_.representation == Representation::kSparse) {
    level.editCell(slot).anchor = unitHash(level.voxel(slot)) < kNewShare;
    select(l, slot, level.cell(slot).anchor);
  }
  if (config_.representation == Representation::kRandom) {
    select(l, slot, unitHash(level.voxel(slot)) < random_share_[static_cast<size_t>(l - 1)]);
  }
}

void MapBuilder::markOccupied(const VoxelIndex& v) {
  for (int l = 1; l < levels(); ++l) {
    if (!match_map_.occupied(l).set(coarser(v, l - 1))) return;
  }
}

/// A thawed voxel without a cell is passed over: the coarser one may have one.
void MapBuilder::countEdges(int l, const VoxelIndex& v) {
  const uint32_t slot = match_map_.surfaces(l).slotOf(v);
  if (slot != SurfaceLevel::kNone) {
    const uint8_t before = moments(l).cell(slot).edge_children;
    const uint8_t now = edgeChildrenOf(edgeVoxels(), l, v);
    if (now != before) momentLevel(l).editCell(slot).edge_children = now;
    if ((now != 0) == (before != 0)) return;
    touch(l, slot);
  }
  if (l < MatchMap::kSurfaceLevels) countEdges(l + 1, coarser(v, 1));
}

void MapBuilder::touch(int l, uint32_t slot) {
  if (config_.representation == Representation::kAll) return;
  touched_[static_cast<size_t>(l - 1)].push_back(slot);
}

void MapBuilder::chooseAnchorsAnew() {
  for (int l = 1; l <= MatchMap::kSurfaceLevels; ++l) {
    MomentLevel& level = momentLevel(l);
    const SurfaceLevel& surfaces = match_map_.surfaces(l);
    auto& slots = touched_[static_cast<size_t>(l - 1)];
    sortUnique(slots);
    std::vector<size_t> blocks(slots.size());
    for (size_t i = 0; i < slots.size(); ++i) {
      blocks[i] = kNoBlock;
      if (!level.hasCell(slots[i])) continue;
      if (level.cell(slots[i]).hits >= config_.min_hits) level.findFlatAxis(slots[i]);
      blocks[i] = surfaces.blockOf(level.voxel(slots[i]));
    }
    slots.clear();
    sortUnique(blocks);
    if (!blocks.empty() && blocks.back() == kNoBlock) blocks.pop_back();
    const int count = l == 1 ? config_.anchors : (config_.anchors + 1) / 2;
    for (const size_t block : blocks) {
      chooseAnchors(level, surfaces, block, {count, config_.min_hits});
      if (config_.representation != Representation::kSparse) continue;
      surfaces.forEachInBlock(block,
                              [&](uint32_t slot) { select(l, slot, level.cell(slot).anchor); });
    }
  }
}

void MapBuilder::label() {
  BitGrid<16> relabelled;
  Dilation<16>(labeller_.reach(), hit_voxels_, relabelled).add(changed_);
  changed_.clear();
  labeller_.label(hit_voxels_, relabelled, edge_candidates_);
  BitGrid<16> targets;
  Dilation<16>(1, hit_voxels_, targets).add(relabelled);
  BitGrid<16>& edges = match_map_.edgeVoxels();
  std::vector<BitGrid<16>::Block> before(targets.blockCount());
  for (size_t slot = 0; slot < before.size(); ++slot) {
    const auto* known = edges.findBlock(targets.blockIndex(slot));
    before[slot] = known == nullptr ? BitGrid<16>::Block{} : *known;
  }
  thinEdges(edge_candidates_, targets, edge_neighbours_, edges);
  changeEdges(targets, before);
  if (config_.representation == Representation::kEdges) return selectEdges();
  chooseAnchorsAnew();
  if (config_.representation == Representation::kRandom) selectRandom();
}

void MapBuilder::changeEdges(const BitGrid<16>& targets,
                             const std::vector<BitGrid<16>::Block>& before) {
  for (size_t slot = 0; slot < before.size(); ++slot) {
    const VoxelIndex& block = targets.blockIndex(slot);
    const auto* now = edgeVoxels().findBlock(block);
    if (now == nullptr) continue;
    BitGrid<16>::Block differs;
    for (size_t row = 0; row < now->size(); ++row) {
      differs[row] = static_cast<uint16_t>((*now)[row] ^ before[slot][row]);
    }
    BitGrid<16>::forEachInBlock(block, differs,
                                [&](const VoxelIndex& v) { countEdges(1, coarser(v, 1)); });
  }
}

void MapBuilder::selectRandom() {
  for (int l = 1; l <= MatchMap::kSurfaceLevels; ++l) {
    const MomentLevel& level = moments(l);
    size_t anchors = 0;
    size_t candidates = 0;
    for (uint32_t slot = 0; slot < level.size(); ++slot) {
      if (!level.hasCell(slot) || level.cell(slot).is_back) continue;
      anchors += level.cell(slot).anchor ? 1 : 0;
      candidates += level.cell(slot).hits >= config_.min_hits ? 1 : 0;
    }
    double& share = random_share_[static_cast<size_t>(l - 1)];
    share = static_cast<double>(anchors) / static_cast<double>(candidates);
    for (uint32_t slot = 0; slot < level.size(); ++slot) {
      if (!level.hasCell(slot)) continue;
      const MomentLevel::Cell& cell = level.cell(slot);
      if (cell.is_back) continue;
      select(l, slot, cell.hits >= config_.min_hits && unitHash(level.voxel(slot)) < share);
    }
  }
}

void MapBuilder::prepareAll() {
  for (int l = 1; l <= MatchMap::kSurfaceLevels; ++l) {
    momentLevel(l).updateAll(match_map_.surfaces(l));
  }
}

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
  hit_voxels_ = {};
  edge_candidates_ = {};
  changed_ = {};
  touched_ = {};
  random_share_ = {};
  match_map_ = MatchMap(voxel_size_, config_.coarsest_voxel);
  far_ = {};
  moments_.clear();
  for (int l = 1; l <= MatchMap::kSurfaceLevels; ++l) moments_.emplace_back(voxelSize(l));
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
  size_t bytes = hit_grid_.bytes() + hits_.bytes() + hit_slots_.bytes() + hit_voxels_.bytes() +
                 edge_candidates_.bytes() + changed_.bytes() + match_map_.bytes() +
                 lone_voxels_.bytes() + scan_.neighbours.bytes() + far_.bytes();
  for (const MomentLevel& level : moments_) bytes += level.bytes();
  for (const auto& slots : touched_) bytes += slots.capacity() * sizeof(uint32_t);
  return bytes;
}

size_t MapBuilder::usedBytes() const {
  size_t free = hit_grid_.freeBytes() + hit_slots_.freeCount(Slots::kNear) * sizeof(Hit) +
                hit_voxels_.freeBytes() + edge_candidates_.freeBytes() + match_map_.freeBytes();
  for (int l = 1; l <= MatchMap::kSurfaceLevels; ++l) {
    free += match_map_.surfaces(l).slots().freeCount(Slots::kNear) * MomentLevel::kCellBytes;
  }
  return bytes() - free;
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
