// SPDX-License-Identifier: BSD-3-Clause
// What stands along a stretch of street.
#pragma once

#include "sim/parts.hpp"
#include "sim/random.hpp"

namespace edgevox::sim {

constexpr double kRoadHalf = 4.6;  ///< m, centre to kerb
constexpr double kFacade = 7.6;    ///< m, centre to façades
constexpr double kKerb = 0.12;     ///< m

struct Stretch {
  Place start;    ///< an end of the centre line; x along the street, y to its left side
  double length;  ///< m, to the other end
};

/// One row of houses from `begin` to `end` (m along the stretch), on its left or right side.
void addRow(Solids& solids, const Stretch& stretch, bool left, double begin, double end,
            Random& random);

/// Parked cars, `y` m to the left of the centre.
void parkCars(Solids& solids, const Stretch& stretch, double y, Random& random);

/// Lamps, trees and signs on both sides.
void addPoles(Solids& solids, const Stretch& stretch, Random& random);

}  // namespace edgevox::sim
