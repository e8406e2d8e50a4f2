// SPDX-License-Identifier: BSD-3-Clause
// Places out of reach keep what scans are matched to; what is accumulated there is packed or
// dropped until scans come back.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/map/edge_children.hpp"
#include "core/map/packed_bits.hpp"
#include "edgevox/map/map_builder.hpp"

namespace edgevox {
namespace {

using Layout = BitGrid<16>::Layout;

constexpr uint32_t kRecent = 10;  // scans after whose touch no region freezes
constexpr double kEnough = 0.9;   // of map/memory, down to which regions freeze
constexpr size_t kCentroidBytes = FrozenRegion::kCentroidBytes;
constexpr double kSteps = 256.0;  // of a centroid's coordinate in a voxel
const double kDiagonal = FarRegions::kSide * std::sqrt(3.0);  // [voxels]

uint8_t quantised(double in_voxel) {
  return static_cast<uint8_t>(std::clamp(std::floor(kSteps * in_voxel), 0.0, kSteps - 1.0));
}

/// From the voxel's corner [voxel].
Eigen::Vector3d centroidIn(const uint8_t* bytes) {
  return Eigen::Vector3d(bytes[0] + 0.5, bytes[1] + 0.5, bytes[2] + 0.5) / kSteps;
}

/// Bits of a block before a voxel of it.
size_t countBefore(const BitGrid<16>::Block& block, const VoxelIndex& v) {
  size_t count = 0;
  const auto row = static_cast<size_t>(Layout::row(v));
  for (size_t r = 0; r < row; ++r) count += block[r] == 0 ? 0 : bitCount(block[r]);
  return count + bitCount(block[row] & ((1U << Layout::column(v)) - 1));
}

/// Calls visit(VoxelIndex) for the blocks of a SurfaceLevel that lie in a region.
template <typename Visit>
void forEachSurfaceBlock(const VoxelIndex& region, Visit&& visit) {
  constexpr int kSide = FarRegions::kSide / 16;
  for (int i = 0; i < kSide * kSide * kSide; ++i) {
    visit(VoxelIndex{region.x * kSide + i % kSide, region.y * kSide + i / kSide % kSide,
                     region.z * kSide + i / (kSide * kSide)});
  }
}

/// Calls visit(index, Block) for the blocks of a frozen region that have hit voxels.
template <typename Visit>
void forEachHitBlock(const VoxelIndex& region, const FrozenRegion& frozen, Visit&& visit) {
  const uint64_t* words = frozen.hit_voxels.data();
  FarRegions::forEachBlock(region, [&](const VoxelIndex& index, size_t i) {
    if ((frozen.blocks >> i & 1) == 0) return;
    BitGrid<16>::Block block{};
    words = readBits(words, block);
    visit(index, block);
  });
}

template <typename Visit>
void forEachVoxel(const BitGrid<16>& grid, const VoxelIndex& block, Visit&& visit) {
  const auto* bits = grid.findBlock(block);
  if (bits != nullptr) BitGrid<16>::forEachInBlock(block, *bits, visit);
}

}  // namespace

void MapBuilder::freezeFar(const Eigen::Vector3d& sensor) {
  if (config_.freeze_after == 0) return;
  const auto after = static_cast<uint32_t>(config_.freeze_after);
  if (scans_ > after && freezeDue()) {
    freezeAll(
        far_.untouched(sensor / voxel_size_, max_range_ / voxel_size_ + kDiagonal, scans_ - after));
  }
  const auto memory = static_cast<double>(memoryBytes());
  if (scans_ <= kRecent || static_cast<double>(usedBytes()) < memory) return;
  const auto regions = far_.untouched(sensor / voxel_size_, 0.0, scans_ - kRecent);
  const auto enough = [&] { return static_cast<double>(usedBytes()) < kEnough * memory; };
  auto first = regions.begin();
  while (first != regions.end() && !enough()) {
    const auto last = first + std::min<std::ptrdiff_t>(16, regions.end() - first);
    freezeAll({first, last});
    first = last;
  }
}

/// Right after a labelling, so that freezing needs none of its own.
bool MapBuilder::freezeDue() const {
  const bool labelled = config_.representation != Representation::kAll;
  const int interval = labelled ? config_.label_every : config_.freeze_after;
  return (scans_ - 1) % static_cast<uint32_t>(interval) == 0;
}

void MapBuilder::freezeAll(const std::vector<VoxelIndex>& regions) {
  if (regions.empty()) return;
  const bool labelled = changed_.blockCount() == 0 && touched_.empty();
  if (!labelled) label();
  for (const VoxelIndex& region : regions) freeze(region);
}

void MapBuilder::freeze(const VoxelIndex& region) {
  FrozenRegion frozen;
  packVoxels(region, frozen);
  dropHits(region);
  std::vector<PackedCell> cells;
  packCells(region, cells);
  const auto* bytes = reinterpret_cast<const uint8_t*>(cells.data());
  frozen.data.insert(frozen.data.end(), bytes, bytes + cells.size() * sizeof(PackedCell));
  far_.freeze(region, std::move(frozen));
}

void MapBuilder::packVoxels(const VoxelIndex& region, FrozenRegion& frozen) {
  const BitGrid<16>& edges = edgeVoxels();
  std::vector<bool> candidates;
  FarRegions::forEachBlock(region, [&](const VoxelIndex& block, size_t i) {
    forEachVoxel(edges, block, [&](const VoxelIndex& v) {
      const Eigen::Vector3d at = centroid(v) / voxel_size_;
      for (const uint8_t byte :
           {quantised(at.x() - v.x), quantised(at.y() - v.y), quantised(at.z() - v.z)}) {
        frozen.data.push_back(byte);
      }
    });
    frozen.edges_to[i] = static_cast<uint16_t>(frozen.data.size() / kCentroidBytes);
    forEachVoxel(match_map_.hitVoxels(), block,
                 [&](const VoxelIndex& v) { candidates.push_back(edge_candidates_.test(v)); });
    edge_candidates_.eraseBlock(block);
    const auto* bits = match_map_.hitVoxels().findBlock(block);
    if (bits == nullptr) return;
    frozen.blocks = static_cast<uint8_t>(frozen.blocks | 1U << i);
    appendBits(*bits, frozen.hit_voxels);
    match_map_.hitVoxels().eraseBlock(block);
  });
  const size_t first = frozen.data.size();
  frozen.data.resize(first + (candidates.size() + 7) / 8);
  for (size_t i = 0; i < candidates.size(); ++i) {
    if (candidates[i]) frozen.data[first + i / 8] |= static_cast<uint8_t>(1U << (i & 7));
  }
  frozen.voxels = static_cast<uint16_t>(candidates.size());
}

void MapBuilder::dropHits(const VoxelIndex& region) {
  constexpr int kBlocks = FarRegions::kSide / 8;
  for (int i = 0; i < kBlocks * kBlocks * kBlocks; ++i) {
    const VoxelIndex block{region.x * kBlocks + i % kBlocks,
                           region.y * kBlocks + i / kBlocks % kBlocks,
                           region.z * kBlocks + i / (kBlocks * kBlocks)};
    const int32_t found = hit_grid_.findBlock(block);
    if (found == BlockTable::kNone) continue;
    hit_grid_.forEachInBlock(static_cast<size_t>(found), [&](uint32_t slot) { dropHit(slot); });
    hit_grid_.eraseBlock(block);
  }
}

void MapBuilder::packCells(const VoxelIndex& region, std::vector<PackedCell>& packed) {
  SurfaceLevel& surfaces = match_map_.surfaces();
  forEachSurfaceBlock(region, [&](const VoxelIndex& block) {
    std::vector<VoxelIndex> selected;
    std::vector<VoxelIndex> others;
    surfaces.forEachVoxelInBlock(block, [&](const VoxelIndex& v, uint32_t slot) {
      (moments_.cell(slot).selected ? selected : others).push_back(v);
    });
    for (const VoxelIndex& v : others) moments_.erase(v, surfaces);
    for (const VoxelIndex& v : selected) moments_.pack(v, surfaces, packed);
    surfaces.shrinkBlock(block);
  });
}

void MapBuilder::thawAround(const VoxelIndex& v) {
  if (config_.freeze_after == 0 && far_.frozenCount() == 0) return;
  far_.touch(v, scans_, [this](const VoxelIndex& region) { thaw(region); });
}

void MapBuilder::thaw(const VoxelIndex& region) {
  const auto kept = far_.thaw(region);
  const FrozenRegion& frozen = *kept;
  const uint8_t* edge = frozen.data.data();
  const uint8_t* candidates = edge + frozen.bitsAt();
  size_t voxels = 0;
  forEachHitBlock(region, frozen, [&](const VoxelIndex& index, const BitGrid<16>::Block& block) {
    match_map_.hitVoxels().editBlock(match_map_.hitVoxels().insertBlock(index)) = block;
    BitGrid<16>::forEachInBlock(index, block, [&](const VoxelIndex& v) {
      const bool is_edge = edgeVoxels().test(v);
      reviveHit(v, is_edge ? centroidIn(edge) : Eigen::Vector3d(0.5, 0.5, 0.5));
      if (is_edge) edge += kCentroidBytes;
      if ((candidates[voxels / 8] >> (voxels & 7) & 1) != 0) edge_candidates_.set(v);
      ++voxels;
    });
  });
  std::vector<PackedCell> packed(frozen.cells());
  const uint8_t* cells = frozen.data.data() + frozen.cellsAt();
  if (!packed.empty()) std::memcpy(packed.data(), cells, packed.size() * sizeof(PackedCell));
  unpackCells(region, packed.data());
  ++thawed_count_;
}

BitGrid<16> MapBuilder::hitVoxels() const {
  BitGrid<16> all = match_map_.hitVoxels();
  far_.forEachFrozen([&](const VoxelIndex& region, const FrozenRegion& frozen) {
    forEachHitBlock(region, frozen, [&](const VoxelIndex& index, const BitGrid<16>::Block& block) {
      all.editBlock(all.insertBlock(index)) = block;
    });
  });
  return all;
}

bool MapBuilder::isFrozen(const VoxelIndex& v) const {
  return far_.find(FarRegions::regionOf(v)) != nullptr;
}

bool MapBuilder::isHitWithin(const VoxelIndex& parent) const {
  for (int i = 0; i < kChildren; ++i) {
    if (match_map_.hitVoxels().test(childOf(parent, i))) return true;
  }
  return false;
}

void MapBuilder::reviveHit(const VoxelIndex& v, const Eigen::Vector3d& in_voxel) {
  const uint32_t slot = hitSlot(v);
  Hit& hit = hits_.edit(slot);
  hit.hits = static_cast<uint32_t>(config_.min_hits);
  hit.count = 1;
  for (size_t k = 0; k < 3; ++k) {
    hit.sum[k] = static_cast<float>(voxel_size_ * (in_voxel[static_cast<Eigen::Index>(k)] - 0.5));
  }
}

void MapBuilder::unpackCells(const VoxelIndex& region, const PackedCell* next) {
  SurfaceLevel& surfaces = match_map_.surfaces();
  forEachSurfaceBlock(region, [&](const VoxelIndex& block) {
    std::vector<VoxelIndex> voxels;
    surfaces.forEachVoxelInBlock(block,
                                 [&](const VoxelIndex& v, uint32_t) { voxels.push_back(v); });
    for (const VoxelIndex& v : voxels) {
      next = moments_.unpack(v, surfaces, next, edgeChildrenOf(edgeVoxels(), v));
    }
  });
}

Eigen::Vector3d MapBuilder::frozenCentroid(const VoxelIndex& v) const {
  if (!edgeVoxels().test(v)) return voxelCentre(v, voxel_size_);
  const VoxelIndex block = Layout::block(v);
  const auto i = static_cast<size_t>((block.x & 1) + 2 * (block.y & 1) + 4 * (block.z & 1));
  const FrozenRegion& frozen = *far_.find(FarRegions::regionOf(v));
  const size_t before =
      (i == 0 ? 0 : frozen.edges_to[i - 1]) + countBefore(*edgeVoxels().findBlock(block), v);
  return voxel_size_ *
         (Eigen::Vector3d(v.x, v.y, v.z) + centroidIn(&frozen.data[kCentroidBytes * before]));
}

void MapBuilder::checkFrozen(const VoxelIndex& region, const FrozenRegion& frozen) const {
  size_t edges = 0;
  bool good = true;
  FarRegions::forEachBlock(region, [&](const VoxelIndex& block, size_t i) {
    forEachVoxel(edgeVoxels(), block, [&](const VoxelIndex&) { ++edges; });
    good = good && edges == frozen.edges_to[i];
  });
  size_t cells = 0;
  const SurfaceLevel& surfaces = match_map_.surfaces();
  forEachSurfaceBlock(region, [&](const VoxelIndex& block) {
    surfaces.forEachVoxelInBlock(
        block, [&](const VoxelIndex&, uint32_t slot) { cells += surfaces.hasBack(slot) ? 2 : 1; });
  });
  if (!good || cells != frozen.cells()) {
    throw ArchiveError("a frozen region does not fit to its edges and surfaces");
  }
}

}  // namespace edgevox
