// SPDX-License-Identifier: BSD-3-Clause
// Global registration with PCL, to compare with: FPFH features, SAC-IA, then ICP.
#pragma once

#include <memory>

#include "edgevox/grid/voxel.hpp"
#include "edgevox/map/match_map.hpp"
#include "edgevox/scan/voxel_scan.hpp"

namespace edgevox {

constexpr double kPclLeaf = 0.4;       ///< of the voxel filter of scan and map [m]
constexpr double kNormalRadius = 1.0;  ///< of a point's neighbours for its normal [m]
constexpr double kFpfhRadius = 2.0;    ///< of those for its feature [m]
constexpr int kSacIterations = 1000;

/// Looks for scans in a map, all over it.
class PclSearch {
 public:
  explicit PclSearch(const MatchMap& map);
  ~PclSearch();

  /// T_map_sensor of a scan seen at once. Repeatable.
  Pose find(const VoxelScan& scan) const;

 private:
  struct Described;  // points with their features

  std::unique_ptr<Described> map_;
};

}  // namespace edgevox
