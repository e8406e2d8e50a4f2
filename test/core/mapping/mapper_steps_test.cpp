// SPDX-License-Identifier: BSD-3-Clause
// A mapper that hands out the pose before it inserts the scan.
#include <vector>

#include <gtest/gtest.h>

#include "edgevox/mapping/mapper.hpp"
#include "support/sweeps.hpp"
#include "support/voxel_sets.hpp"

namespace edgevox::test {
namespace {

TEST(MapperSteps, AreTheWholeInTwo) {
  Mapper whole{Config{}};
  Mapper steps{Config{}};
  for (const VoxelScan& scan : buildingScans()) {
    const ScanResult expected = whole.process(scan);
    ScanResult result = steps.track(scan);
    EXPECT_EQ(expected.status, result.status);
    EXPECT_TRUE(sameBits(expected.T_map_sensor, result.T_map_sensor));
    EXPECT_EQ(0.0, result.times.insert);
    EXPECT_EQ(whole.map().scans(), steps.map().scans() + 1) << "not inserted yet";
    steps.insert(scan, result);
    EXPECT_GT(result.times.insert, 0.0);
    EXPECT_EQ(whole.map().scans(), steps.map().scans());
  }
  EXPECT_TRUE(sameVoxels(voxelsOf(whole.map().hitVoxels()), voxelsOf(steps.map().hitVoxels())));
  EXPECT_TRUE(sameVoxels(voxelsOf(whole.map().edgeVoxels()), voxelsOf(steps.map().edgeVoxels())));
  EXPECT_EQ(whole.recentEdges().edgeCentroids(), steps.recentEdges().edgeCentroids());
}

TEST(MapperSteps, LeaveTheMapToAScanThatIsLost) {
  Mapper mapper{Config{}};
  for (const VoxelScan& scan : buildingScans()) mapper.process(scan);
  const auto before = voxelsOf(mapper.map().hitVoxels());
  const VoxelScan lost =
      voxelScans({randomSweep(7, buildingScans().back().stamp + 0.1, 20000)}, Config{}).front();
  EXPECT_EQ(ScanStatus::kLost, mapper.track(lost).status);
  EXPECT_TRUE(sameVoxels(before, voxelsOf(mapper.map().hitVoxels())));
}

}  // namespace
}  // namespace edgevox::test
