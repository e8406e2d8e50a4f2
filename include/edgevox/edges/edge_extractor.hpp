// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "edgevox/config.hpp"
#include "edgevox/grid/block_grid.hpp"
#include "edgevox/grid/voxel.hpp"
#include "edgevox/scan/voxel_scan.hpp"

namespace edgevox {

/// Labels occupied voxels that lie on geometric edges by the structure tensor of the occupancy
/// (Ryde, Delmerico, Corso 2013, eq. 5-7). A label depends on the voxels within `reach` of its
/// own alone, so it is the same for any block edge, number of threads and instruction set.
template <int kSide>
class EdgeLabeller {
 public:
  using Grid = BitGrid<kSide>;

  /// `thresholds` instead of those in `config`. Their support is the covariance of the occupied
  /// positions in the 7^3 neighbourhood. Throws ConfigError when the instruction set asked for is
  /// not to be had.
  EdgeLabeller(const EdgeConfig& config, const EdgeThresholds& thresholds, int threads);

  /// How far a change of occupancy changes labels [voxels, in each axis].
  int reach() const;

  /// Labels the `targets`, which must be occupied, anew; other voxels of `edges` stay. `sparse`, if
  /// not null, becomes the number of targets as in EdgeCount::sparse.
  void label(const Grid& occupied, const Grid& targets, Grid& edges,
             size_t* sparse = nullptr) const;

 private:
  EdgeConfig config_;
  EdgeThresholds thresholds_;
  int threads_;
};

extern template class EdgeLabeller<8>;
extern template class EdgeLabeller<16>;
extern template class EdgeLabeller<32>;

/// Structure tensor and support look at several voxels, so edges come as bands: of the
/// `candidates` among `targets` those become `edges` that have at least `neighbours` other
/// candidates in their 3^3 neighbourhood. Other voxels of `edges` stay.
template <int kSide>
void thinEdges(const BitGrid<kSide>& candidates, const BitGrid<kSide>& targets, int neighbours,
               BitGrid<kSide>& edges);

extern template void thinEdges<8>(const BitGrid<8>&, const BitGrid<8>&, int, BitGrid<8>&);
extern template void thinEdges<16>(const BitGrid<16>&, const BitGrid<16>&, int, BitGrid<16>&);
extern template void thinEdges<32>(const BitGrid<32>&, const BitGrid<32>&, int, BitGrid<32>&);

struct EdgeCount {
  size_t occupied = 0;  ///< voxels of the map's size
  size_t edges = 0;
  /// Voxels in whose structure tensor no eigenvalue reaches a tenth of a plane's largest: a large
  /// share tells that the points lie too far apart for the voxel size.
  size_t sparse = 0;

  /// Share of the occupied voxels that are sparse; 0 if there are none.
  double sparseShare() const {
    return occupied > 0 ? static_cast<double>(sparse) / static_cast<double>(occupied) : 0.0;
  }
};

/// Labels the edges of one scan at the map's voxel size.
class EdgeExtractor {
 public:
  EdgeExtractor(const EdgeConfig& config, int threads);

  /// Sets ScanVoxel::edge: whether the voxel of twice the size that holds it is an edge.
  EdgeCount extract(VoxelScan& scan);

 private:
  void setFlags(VoxelScan& scan) const;

  EdgeLabeller<16> labeller_;
  BitGrid<16> occupied_;
  BitGrid<16> edges_;
};

}  // namespace edgevox
