// SPDX-License-Identifier: BSD-3-Clause
// When scans are too sparse for their voxels, and which voxels would do.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "edgevox/edges/density_monitor.hpp"
#include "support/scenes.hpp"

namespace edgevox::test {
namespace {

const EdgeConfig kConfig;
constexpr double kMapVoxel = 0.1;  // [m]

/// The voxels are of the map's size; each is hit once.
VoxelScan scanOf(const Voxels& voxels, double stamp = 0.0, double map_voxel = kMapVoxel) {
  VoxelScan scan;
  scan.stamp = stamp;
  scan.voxel_size = map_voxel / 2;
  for (const VoxelIndex& v : voxels) {
    scan.voxels.emplace_back().index = {2 * v.x, 2 * v.y, 2 * v.z};
  }
  return scan;
}

/// Voxels of a plane, each `spacing` from the next.
Voxels lattice(int32_t spacing) {
  constexpr int32_t kSide = 24;
  Voxels voxels;
  for (int32_t y = 0; y < kSide; ++y) {
    for (int32_t z = 0; z < kSide; ++z) voxels.push_back({0, spacing * y, spacing * z});
  }
  return voxels;
}

EdgeCount countOf(VoxelScan scan) { return EdgeExtractor(kConfig, 1).extract(scan); }

void add(const VoxelScan& scan, DensityMonitor& alarm) { alarm.add(scan, countOf(scan)); }

DensityMonitor alarmAfter(const VoxelScan& scan) {
  DensityMonitor alarm(kConfig, 1, DensityMonitor::kEveryScan);
  add(scan, alarm);
  return alarm;
}

double adviceOn(const Voxels& voxels, double map_voxel) {
  const VoxelScan scan = scanOf(voxels, 0.0, map_voxel);
  return denserVoxelSize(scan, kConfig, 1).value_or(0.0);
}

TEST(SparseShare, IsThatOfTheExtractorInVoxelsOfThatSize) {
  Random random(3);
  const VoxelScan scan = scanOf(randomCloud(random, 40, 0.004));
  size_t different = 0;
  double last = 1.0;
  for (int doublings = 0; doublings < 4; ++doublings) {
    VoxelScan coarse = scan;
    for (ScanVoxel& voxel : coarse.voxels) voxel.index = coarser(voxel.index, doublings);
    const double share = sparseShare(scan, doublings, kConfig, 2);
    EXPECT_EQ(countOf(coarse).sparseShare(), share) << doublings;
    different += share < last ? 1 : 0;
    last = share;
  }
  EXPECT_GT(different, 1U) << "the scan does not tell the sizes apart";
  EXPECT_EQ(0.0, sparseShare(VoxelScan(), 0, kConfig, 1));
}

TEST(DensityMonitor, IsSilentOnSurfacesWithoutGaps) {
  Random random(5);
  const DensityMonitor alarm = alarmAfter(scanOf(roomScene(random, {60, 50, 30}).voxels));
  EXPECT_LT(alarm.share(), 0.02);
  EXPECT_FALSE(alarm.warning());
}

TEST(DensityMonitor, NamesTheVoxelThatSpansTheGaps) {
  for (const int32_t spacing : {4, 8, 16}) {
    const VoxelScan scan = scanOf(lattice(spacing));
    const auto warning = alarmAfter(scan).warning();
    ASSERT_TRUE(warning) << spacing;
    EXPECT_GT(warning->share, 0.9);
    const int doublings = static_cast<int>(std::lround(std::log2(warning->voxel_size / kMapVoxel)));
    EXPECT_LE(sparseShare(scan, doublings, kConfig, 1), kSparseLimit);
    EXPECT_GT(sparseShare(scan, doublings - 1, kConfig, 1), kSparseLimit);
    EXPECT_LE(warning->voxel_size, spacing * kMapVoxel * 1.001) << "the gaps are filled before";
  }
}

TEST(DensityMonitor, NamesSizesOfTheSeries) {
  const Voxels voxels = lattice(4);
  const double at_10_cm = adviceOn(voxels, 0.1);
  EXPECT_TRUE(at_10_cm == 0.2 || at_10_cm == 0.4) << at_10_cm;
  EXPECT_DOUBLE_EQ(at_10_cm / 2, adviceOn(voxels, 0.05));
  EXPECT_DOUBLE_EQ(at_10_cm * 2, adviceOn(voxels, 0.15)) << "rounded up";
  EXPECT_DOUBLE_EQ(at_10_cm * 2, adviceOn(voxels, 0.2));
  EXPECT_EQ(0.0, adviceOn(voxels, 10.0)) << "out of the range of voxel_size";
  EXPECT_EQ(0.0, adviceOn(lattice(1000), 0.1)) << "no voxel will do";
}

TEST(DensityMonitor, LooksAtTheMedianOfItsWindow) {
  DensityMonitor alarm(kConfig, 1, 5);
  EXPECT_TRUE(std::isnan(alarm.share()));
  EXPECT_FALSE(alarm.warning());
  const Voxels sparse = lattice(4), dense = lattice(1);
  for (int i = 0; i < 2; ++i) add(scanOf(sparse, i), alarm);
  EXPECT_TRUE(alarm.warning());
  for (int i = 2; i < 5; ++i) add(scanOf(dense, i), alarm);
  EXPECT_FALSE(alarm.warning());
  for (int i = 5; i < 8; ++i) add(scanOf(sparse, i), alarm);
  EXPECT_TRUE(alarm.warning());
  EXPECT_GT(alarm.share(), 0.9);
}

TEST(DensityMonitor, CountsAgainAtMostEveryThreeSeconds) {
  DensityMonitor alarm(kConfig, 1, 100);
  add(scanOf(lattice(4), 10.0), alarm);
  const double first = alarm.warning()->voxel_size;
  for (const double stamp : {10.5, 11.0, 12.9}) add(scanOf(lattice(16), stamp), alarm);
  EXPECT_EQ(first, alarm.warning()->voxel_size);
  add(scanOf(lattice(16), 13.0), alarm);
  EXPECT_EQ(4 * first, alarm.warning()->voxel_size) << "the larger of two";
  add(scanOf(lattice(4), 2.0), alarm);  // the clock has jumped back
  EXPECT_EQ(first, alarm.warning()->voxel_size);
}

TEST(DensityMonitor, IgnoresScansOfAFewVoxels) {
  Voxels few = lattice(4);
  few.resize(99);
  const DensityMonitor alarm = alarmAfter(scanOf(few));
  EXPECT_TRUE(std::isnan(alarm.share()));
  EXPECT_FALSE(alarm.warning());
}

TEST(DensityWarning, SaysWhatToDo) {
  EXPECT_EQ("too sparse: 31 % of the occupied voxels stand alone; choose voxel_size 0.2 or more",
            textOf({0.312, 0.2}));
  const std::string none = textOf({0.9, 0.0});
  EXPECT_NE(std::string::npos, none.find("90 %")) << none;
  EXPECT_NE(std::string::npos, none.find("no voxel_size")) << none;
}

}  // namespace
}  // namespace edgevox::test
