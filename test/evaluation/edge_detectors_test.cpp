// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/edge_detectors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace edgevox {
namespace {

constexpr int kHalf = 20;      // voxels, of the shapes
constexpr double kSize = 0.1;  // m

VoxelScan scanOf(const std::function<bool(const VoxelIndex&)>& isOccupied) {
  VoxelScan scan;
  scan.voxel_size = kSize;
  for (int z = -kHalf; z <= kHalf; ++z) {
    for (int y = -kHalf; y <= kHalf; ++y) {
      for (int x = -kHalf; x <= kHalf; ++x) {
        if (!isOccupied({x, y, z})) continue;
        ScanVoxel voxel;
        voxel.index = {x, y, z};
        voxel.centroid = voxelCentre(voxel.index, kSize).cast<float>();
        voxel.point_count = 1;
        scan.voxels.push_back(voxel);
      }
    }
  }
  return scan;
}

/// A floor and a wall, which meet in x = z = 0.
VoxelScan bend() {
  return scanOf(
      [](const VoxelIndex& v) { return (v.z == 0 && v.x >= 0) || (v.x == 0 && v.z >= 0); });
}

/// Of the voxels that are far from the rims of the shapes.
double largestIn(const VoxelScan& scan, const Responses& responses,
                 const std::function<bool(const VoxelIndex&)>& isAsked) {
  double largest = 0.0;
  for (size_t i = 0; i < responses.size(); ++i) {
    const VoxelIndex& v = scan.voxels[i].index;
    const int farthest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (farthest <= kHalf - 5 && isAsked(v)) largest = std::max(largest, responses[i]);
  }
  return largest;
}

TEST(EdgeDetectors, RespondToABendMoreThanToAPlane) {
  const VoxelScan scan = bend();
  for (const EdgeDetector& detector : kEdgeDetectors) {
    const Responses responses = detector.respond(scan);
    ASSERT_EQ(scan.voxels.size(), responses.size()) << detector.name;
    EXPECT_TRUE(std::all_of(responses.begin(), responses.end(), [](double r) {
      return std::isfinite(r);
    })) << detector.name;
    const auto near = [](const VoxelIndex& v) { return v.x <= 2 && v.z <= 2; };
    const double plane =
        largestIn(scan, responses, [](const VoxelIndex& v) { return v.x > 4 || v.z > 4; });
    EXPECT_GT(largestIn(scan, responses, near), 1.5 * plane) << detector.name;
  }
}

TEST(EdgeDetectors, HaveTheValuesOfTheirDefinitions) {
  const VoxelScan plane = scanOf([](const VoxelIndex& v) { return v.z == 0; });
  const auto middle =
      static_cast<size_t>(std::find_if(plane.voxels.begin(), plane.voxels.end(),
                                       [](const ScanVoxel& v) { return v.index == VoxelIndex{}; }) -
                          plane.voxels.begin());
  EXPECT_NEAR(surfaceVariation(plane)[middle], 0.0, 1e-9);
  EXPECT_EQ(haarLike(plane)[middle], 0.0);
  EXPECT_EQ(differenceOfGaussians(plane)[middle], 0.0);  // the median itself
  const size_t rim = 0;                                  // a corner
  EXPECT_NEAR(haarLike(plane)[rim], 12.0 * std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(surfaceVariation(plane)[rim], 0.0, 1e-9);

  const VoxelScan full = scanOf([](const VoxelIndex& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) <= 4;
  });
  EXPECT_NEAR(surfaceVariation(full)[full.voxels.size() / 2], 1.0 / 3.0, 1e-6);
  EXPECT_EQ(haarLike(full)[full.voxels.size() / 2], 0.0);
}

TEST(EdgeDetectors, OfNothingIsNothing) {
  VoxelScan nothing;
  nothing.voxel_size = kSize;
  VoxelScan one = nothing;
  one.voxels.resize(1);
  one.voxels[0].point_count = 1;
  for (const EdgeDetector& detector : kEdgeDetectors) {
    EXPECT_TRUE(detector.respond(nothing).empty()) << detector.name;
    const Responses of_one = detector.respond(one);
    ASSERT_EQ(of_one.size(), 1U) << detector.name;
    EXPECT_TRUE(std::isfinite(of_one[0])) << detector.name;
  }
}

TEST(MarkStrongest, MarksSoManyVoxelsOfTheMapsSize) {
  VoxelScan scan = scanOf([](const VoxelIndex& v) { return v.z == 0 || (v.x == 0 && v.z > 0); });
  scan.voxel_size = kSize / 2;  // of a map of kSize
  const EdgeDetector by_height = {"height", [](const VoxelScan& voxels) {
                                    Responses heights;
                                    for (const ScanVoxel& voxel : voxels.voxels) {
                                      heights.push_back(voxel.index.z);
                                    }
                                    return heights;
                                  }};
  markStrongest(by_height, 7, scan);
  const VoxelScan edges = edgeVoxels(scan);
  ASSERT_EQ(edges.voxels.size(), 7U);
  for (const ScanVoxel& voxel : edges.voxels) EXPECT_EQ(voxel.index.z, kHalf / 2);
  markStrongest(by_height, 1000000, scan);
  EXPECT_EQ(edgeVoxels(scan).voxels.size(), inMapVoxels(scan).voxels.size());
  markStrongest(by_height, 0, scan);
  EXPECT_TRUE(edgeVoxels(scan).voxels.empty());
}

}  // namespace
}  // namespace edgevox
