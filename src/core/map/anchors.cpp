// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "edgevox/map/moment_level.hpp"

namespace edgevox {
namespace {

bool isCandidate(const MomentLevel::Cell& cell, int min_hits) {
  return cell.hits >= min_hits && !cell.explained;
}

bool isAnchorByLot(const MomentLevel::Cell& cell) {
  return cell.edge_children == 0 && cell.flat_axis != MomentLevel::kNotFlat;
}

}  // namespace

void chooseAnchors(MomentLevel& level, const SurfaceLevel& surfaces, size_t block,
                   const AnchorRule& rule) {
  std::array<int, 3> flat{};  // by axis
  surfaces.forEachInBlock(block, [&](uint32_t slot) {
    const MomentLevel::Cell& cell = level.cell(slot);
    if (isCandidate(cell, rule.min_hits) && isAnchorByLot(cell)) {
      ++flat[static_cast<size_t>(cell.flat_axis)];
    }
  });
  surfaces.forEachInBlock(block, [&](uint32_t slot) {
    const MomentLevel::Cell& cell = level.cell(slot);
    bool anchor = isCandidate(cell, rule.min_hits);
    if (isAnchorByLot(cell)) {
      const int all = flat[static_cast<size_t>(cell.flat_axis)];
      anchor = anchor && unitHash(level.voxel(slot)) * all < rule.count;
    } else {
      anchor = anchor && cell.edge_children > 0;
    }
    if (cell.anchor != anchor) level.editCell(slot).anchor = anchor;
  });
}

}  // namespace edgevox
