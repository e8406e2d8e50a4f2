// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "edgevox/grid/block_grid.hpp"
#include "tools/map/map_points.hpp"

namespace edgevox {

/// The values of cells, as map_server reads them.
enum FloorCell : char { kBlocked = 0, kUnknownCell = '\xcd', kFreeCell = '\xfe' };

/// A map of map_server: an image seen from above, x to the right and y up.
struct FloorPlan {
  double resolution = 0.0;  ///< side of a cell [m]
  double x = 0.0;           ///< of the image's lower left corner in the map frame [m]
  double y = 0.0;           ///< the same
  size_t width = 0;         ///< [cells]
  size_t height = 0;        ///< [cells]
  std::string cells;        ///< FloorCell, row by row from the top

  /// Binary PGM.
  std::string pgm() const;
  /// The file beside the image of this name.
  std::string yaml(const std::string& image) const;
};

/// Cells are blocked where an occupied voxel has its centre in the band, free where there is none
/// but one below the band: a floor. All else is unknown. Throws FileError if nothing is occupied
/// below the band's upper end, or the image would be too large.
FloorPlan floorPlanOf(const BitGrid<16>& occupied, double voxel_size, const HeightBand& band,
                      double resolution);

}  // namespace edgevox
