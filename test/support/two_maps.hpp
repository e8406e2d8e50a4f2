// SPDX-License-Identifier: BSD-3-Clause
// Two maps of one frame that overlap: of the first and of the last scans of a walk.
#pragma once

#include <vector>

#include "edgevox/config.hpp"
#include "edgevox/mapping/mapper.hpp"
#include "support/sweeps.hpp"

namespace edgevox::test {

struct TwoMaps {
  std::vector<VoxelScan> scans;
  std::vector<Pose> poses;  ///< of all scans in the frame of both maps, as mapped in one go
  Mapper a;
  Mapper b;

  explicit TwoMaps(const Config& config) : a(config), b(config) {
    constexpr int kScans = 36;
    constexpr size_t kEndOfA = 22;
    constexpr size_t kBeginOfB = 16;
    scans = voxelScans(simulateWalk(sim::WorldName::Building, "16", 10, kScans).sweeps, config);
    Mapper whole(config);
    for (const VoxelScan& scan : scans) poses.push_back(whole.process(scan).T_map_sensor);
    for (size_t i = 0; i < kEndOfA; ++i) a.process(scans[i]);
    ScanPrior prior;
    prior.T_map_first = poses[kBeginOfB];
    for (size_t i = kBeginOfB; i < scans.size(); ++i) b.process(scans[i], prior);
    a.finishLabels();
    b.finishLabels();
  }
};

}  // namespace edgevox::test
