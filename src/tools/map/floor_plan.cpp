// SPDX-License-Identifier: BSD-3-Clause
#include "tools/map/floor_plan.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "edgevox/io/atomic_file.hpp"
#include "edgevox/io/number_text.hpp"

namespace edgevox {
namespace {

constexpr int64_t kMostCells = int64_t{1} << 28;
constexpr double kTouching = 1e-6;  // of a cell: a voxel that only touches it does not count

/// Cells of one axis, the last one excluded.
struct Span {
  int64_t first;
  int64_t last;

  Span(int32_t voxel, double cells_per_voxel)
      : first(static_cast<int64_t>(std::floor(voxel * cells_per_voxel + kTouching))),
        last(static_cast<int64_t>(std::ceil((voxel + 1) * cells_per_voxel - kTouching))) {}
  void include(const Span& other) {
    first = std::min(first, other.first);
    last = std::max(last, other.last);
  }
  int64_t size() const { return last - first; }
};

struct Footprint {
  Span x;
  Span y;
  bool blocks;
};

std::vector<Footprint> footprintsOf(const BitGrid<16>& occupied, double voxel_size,
                                    const HeightBand& band, double resolution) {
  const double cells_per_voxel = voxel_size / resolution;
  std::vector<Footprint> footprints;
  occupied.forEach([&](const VoxelIndex& v) {
    const double z = voxelCentre(v, voxel_size).z();
    if (z >= band.to) return;
    footprints.push_back({{v.x, cells_per_voxel}, {v.y, cells_per_voxel}, band.holds(z)});
  });
  return footprints;
}

void fill(const Footprint& footprint, const Span& columns, const Span& rows, FloorPlan& plan) {
  for (int64_t y = footprint.y.first; y < footprint.y.last; ++y) {
    for (int64_t x = footprint.x.first; x < footprint.x.last; ++x) {
      const auto row = static_cast<size_t>(rows.last - 1 - y);
      char& cell = plan.cells[row * plan.width + static_cast<size_t>(x - columns.first)];
      if (footprint.blocks) cell = kBlocked;
      if (cell == kUnknownCell) cell = kFreeCell;
    }
  }
}

}  // namespace

std::string FloorPlan::pgm() const {
  return "P5\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n" + cells;
}

std::string FloorPlan::yaml(const std::string& image) const {
  return "image: \"" + image + "\"\nresolution: " + shortText(resolution, 9) + "\norigin: [" +
         shortText(x, 9) + ", " + shortText(y, 9) +
         ", 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
}

FloorPlan floorPlanOf(const BitGrid<16>& occupied, double voxel_size, const HeightBand& band,
                      double resolution) {
  const std::vector<Footprint> footprints = footprintsOf(occupied, voxel_size, band, resolution);
  if (footprints.empty()) throw FileError("nothing is occupied below " + shortText(band.to) + " m");
  Span columns = footprints[0].x;
  Span rows = footprints[0].y;
  for (const Footprint& footprint : footprints) {
    columns.include(footprint.x);
    rows.include(footprint.y);
  }
  if (columns.size() > kMostCells / rows.size()) {
    throw FileError("the image would have more than 2^28 cells: choose a larger --resolution");
  }
  FloorPlan plan;
  plan.resolution = resolution;
  plan.x = static_cast<double>(columns.first) * resolution;
  plan.y = static_cast<double>(rows.first) * resolution;
  plan.width = static_cast<size_t>(columns.size());
  plan.height = static_cast<size_t>(rows.size());
  plan.cells.assign(plan.width * plan.height, kUnknownCell);
  for (const Footprint& footprint : footprints) fill(footprint, columns, rows, plan);
  return plan;
}

}  // namespace edgevox
