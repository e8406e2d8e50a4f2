// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "edgevox/grid/block_grid.hpp"

namespace edgevox {

/// OctoMap's binary format (.bt) with these voxels of `voxel_size` [m] as occupied leaves; all else
/// is unknown. Throws FileError if a voxel is out of OctoMap's range, 32768 voxels either way.
std::string octomapBytes(const BitGrid<16>& occupied, double voxel_size);

}  // namespace edgevox
