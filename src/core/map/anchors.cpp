// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>

#include "edgevox/map/moment_level.hpp"

namespace edgevox {
namespace {

/// How many voxels of a block could be anchors.
struct Candidates {
  std::array<int, 3> flat{};  // by axis
  int edges = 0;              // not flat
};

bool isFlat(const MomentLevel::Cell& cell) { return cell.flat_axis != MomentLevel::kNotFlat; }

Candidates countCandidates(const MomentLevel& level, const SurfaceLevel& surfaces, size_t block,
                           int min_hits) {
  Candidates candidates;
  surfaces.forEachInBlock(block, [&](uint32_t slot) {
    const MomentLevel::Cell& cell = level.cell(slot);
    if (cell.hits < min_hits) return;
    if (isFlat(cell)) {
      ++candidates.flat[static_cast<size_t>(cell.flat_axis)];
    } else if (cell.edge_children > 0) {
      ++candidates.edges;
    }
  });
  return candidates;
}

}  // namespace

void chooseAnchors(MomentLevel& level, const SurfaceLevel& surfaces, size_t block,
                   const AnchorRule& rule) {
  const Candidates candidates = countCandidates(level, surfaces, block, rule.min_hits);
  const int flat = candidates.flat[0] + candidates.flat[1] + candidates.flat[2];
  const int missing = std::max(0, rule.count - flat);
  surfaces.forEachInBlock(block, [&](uint32_t slot) {
    const MomentLevel::Cell& cell = level.cell(slot);
    const double lot = unitHash(level.voxel(slot));
    bool anchor = false;
    if (cell.hits >= rule.min_hits) {
      anchor = isFlat(cell)
                   ? lot * candidates.flat[static_cast<size_t>(cell.flat_axis)] < rule.count
                   : cell.edge_children > 0 && lot * candidates.edges < missing;
    }
    if (cell.anchor != anchor) level.editCell(slot).anchor = anchor;
  });
}

}  // namespace edgevox
