// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/voxel_tree.hpp"

#include <algorithm>

#include "edgevox/archive.hpp"

namespace edgevox {
namespace {

constexpr int kLevels = 5;

/// Which of its parent's children v is, as in childOf().
int placeInParent(const VoxelIndex& v) { return (v.x & 1) | (v.y & 1) << 1 | (v.z & 1) << 2; }

/// With the sign away, so that the order is that of unsigned numbers.
uint32_t unsignedOf(int32_t i) { return static_cast<uint32_t>(i + kIndexLimit); }

}  // namespace

/// By the highest bit in which they differ; where that is the same, z before y before x.
bool isBeforeInTree(const VoxelIndex& a, const VoxelIndex& b) {
  const uint32_t x = unsignedOf(a.x) ^ unsignedOf(b.x);
  const uint32_t y = unsignedOf(a.y) ^ unsignedOf(b.y);
  const uint32_t z = unsignedOf(a.z) ^ unsignedOf(b.z);
  const auto isLower = [](uint32_t bits, uint32_t than) {
    return bits < than && bits < (bits ^ than);
  };
  if (!isLower(z, y) && !isLower(z, x)) return a.z < b.z;
  return isLower(y, x) ? a.x < b.x : a.y < b.y;
}

std::vector<VoxelIndex> besideEdges(const BitGrid<16>& hit, const BitGrid<16>& edges) {
  BitGrid<8> holding;
  edges.forEach([&](const VoxelIndex& v) { holding.set(coarser(v, 1)); });
  std::vector<VoxelIndex> beside = inTreeOrder(hit);
  const auto isElsewhere = [&](const VoxelIndex& v) {
    return edges.test(v) || !holding.test(coarser(v, 1));
  };
  beside.erase(std::remove_if(beside.begin(), beside.end(), isElsewhere), beside.end());
  return beside;
}

VoxelTree::VoxelTree(const std::vector<VoxelIndex>& voxels) : children(kLevels) {
  std::vector<VoxelIndex> level = voxels;
  for (int l = kLevels - 1; l >= 0; --l) {
    std::string& masks = children[static_cast<size_t>(l)].bytes;
    std::vector<VoxelIndex> parents;
    for (const VoxelIndex& v : level) {
      const VoxelIndex parent = coarser(v, 1);
      if (parents.empty() || parents.back() != parent) {
        parents.push_back(parent);
        masks.push_back('\0');
      }
      masks.back() = static_cast<char>(masks.back() | 1 << placeInParent(v));
    }
    level = std::move(parents);
  }
  roots = std::move(level);
}

std::vector<VoxelIndex> VoxelTree::voxels() const {
  const auto fail = [] { throw ArchiveError("a set of voxels is damaged"); };
  const auto isInRange = [](const VoxelIndex& v) {
    constexpr int32_t kLimit = kIndexLimit >> kLevels;
    const auto ok = [](int32_t i) { return i >= -kLimit && i < kLimit; };
    return ok(v.x) && ok(v.y) && ok(v.z);
  };
  if (children.size() != kLevels) fail();
  if (!std::all_of(roots.begin(), roots.end(), isInRange)) fail();
  if (!std::is_sorted(roots.begin(), roots.end(), isBeforeInTree)) fail();
  if (std::adjacent_find(roots.begin(), roots.end()) != roots.end()) fail();
  std::vector<VoxelIndex> level = roots;
  for (const PackedBytes& packed : children) {
    const std::string& masks = packed.bytes;
    if (masks.size() != level.size()) fail();
    std::vector<VoxelIndex> finer;
    for (size_t i = 0; i < level.size(); ++i) {
      if (masks[i] == '\0') fail();
      for (int c = 0; c < kChildren; ++c) {
        if (((masks[i] >> c) & 1) != 0) finer.push_back(childOf(level[i], c));
      }
    }
    level = std::move(finer);
  }
  return level;
}

}  // namespace edgevox
