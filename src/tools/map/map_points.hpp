// SPDX-License-Identifier: BSD-3-Clause
// Of maps what is drawn and converted: points of a height band, and files of them.
#pragma once

#include <filesystem>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "edgevox/grid/block_grid.hpp"
#include "edgevox/map/match_map.hpp"
#include "tools/options.hpp"

namespace edgevox {

/// Heights of the map frame from `from` up to, but without, `to` [m].
struct HeightBand {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();

  bool holds(double z) const { return z >= from && z < to; }
};

/// The options --from and --to; without one, the band is open there. bandOf() throws UsageError if
/// it is empty.
void addBandOptions(boost::program_options::options_description& known);
HeightBand bandOf(const boost::program_options::variables_map& given);

/// The edges whose centroid lies in the band, in their order.
std::vector<EdgeVoxel> edgesIn(const MatchMap& map, const HeightBand& band);
/// Centres [m] of the voxels, as far as they lie in the band, in the order of the voxels.
std::vector<Eigen::Vector3f> centresOf(std::vector<VoxelIndex> voxels, double voxel_size,
                                       const HeightBand& band = {});
std::vector<VoxelIndex> allVoxels(const BitGrid<16>& grid);

/// Binary files of x, y, z [m] and the unit vector along the edge, which is nx, ny, nz in PLY and
/// normal_x, normal_y, normal_z in PCD; complete or not there at all. Throw FileError.
void writeEdgesPly(const std::filesystem::path& file, const std::vector<EdgeVoxel>& edges);
void writeEdgesPcd(const std::filesystem::path& file, const std::vector<EdgeVoxel>& edges);

}  // namespace edgevox
