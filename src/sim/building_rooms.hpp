// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/parts.hpp"
#include "sim/random.hpp"

namespace edgevox::sim {

// Columns, furniture and door leaves of the building's storeys, clear of walkBuilding().
void furnishGroundFloor(Solids& solids, Random& random);
void furnishUpperFloor(Solids& solids, double floor, Random& random);

}  // namespace edgevox::sim
