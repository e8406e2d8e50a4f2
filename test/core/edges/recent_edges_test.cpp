// SPDX-License-Identifier: BSD-3-Clause
// Edges of the last scan by the occupancy of a few scans.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "edgevox/edges/recent_edges.hpp"
#include "edgevox/mapping/mapper.hpp"
#include "support/reference_extractor.hpp"
#include "support/scenes.hpp"
#include "support/sweeps.hpp"

namespace edgevox::test {
namespace {

using Centroids = std::vector<Eigen::Vector3d>;

constexpr double kSize = 0.2;     // [m]
constexpr int kNeighbours = 5;    // of an edge, by default
constexpr double kFar = 1048575;  // voxels; the first that are out of range

Centroids centresOf(const Voxels& voxels) {
  Centroids centres;
  for (const VoxelIndex& v : voxels) centres.push_back(voxelCentre(v, kSize));
  return centres;
}

Voxels joined(const std::vector<Voxels>& scans) {
  Voxels all;
  for (const Voxels& scan : scans) all.insert(all.end(), scan.begin(), scan.end());
  return sorted(std::move(all));
}

/// By the definition, on the union of the scans.
Voxels expectedEdges(const std::vector<Voxels>& scans, const EdgeConfig& config = {}) {
  const ReferenceExtractor reference(joined(scans));
  const bool paper = config.mode == EdgeMode::kPaper;
  const EdgeThresholds thresholds{config.map.ratio, config.scan.support};
  const Voxels candidates =
      paper ? reference.paperEdges() : reference.edges(config.magnitude, thresholds);
  const auto edges = gridOf<16>(thinnedAtOnce(candidates, paper ? 0 : kNeighbours));
  Voxels of_last;
  for (const VoxelIndex& v : scans.back()) {
    if (edges.test(v)) of_last.push_back(v);
  }
  return of_last;
}

/// Scans that see different parts of a corner.
std::vector<Voxels> partsOfACorner(size_t count, uint32_t seed) {
  Random random(seed);
  const Voxels all = cornerScene(random, 16).voxels;
  std::vector<Voxels> scans(count);
  for (const VoxelIndex& v : all) {
    for (Voxels& scan : scans) {
      if (random.chance(0.4)) scan.push_back(v);
    }
  }
  return scans;
}

RecentEdges recentOf(const std::vector<Voxels>& scans, int window, int threads = 1,
                     const EdgeConfig& config = {}) {
  RecentEdges recent(kSize, config, window, threads);
  for (const Voxels& scan : scans) recent.add(centresOf(scan));
  return recent;
}

TEST(RecentEdges, EqualTheReferenceOnTheScansOfTheWindow) {
  const auto scans = partsOfACorner(5, 3);
  for (const int window : {1, 2, 4, 5, 100}) {
    const size_t first = scans.size() - std::min(scans.size(), static_cast<size_t>(window));
    const std::vector<Voxels> in_window(scans.begin() + static_cast<std::ptrdiff_t>(first),
                                        scans.end());
    const Voxels expected = expectedEdges(in_window);
    EXPECT_TRUE(sameVoxels(expected, voxelsOf(recentOf(scans, window).edgeVoxels()))) << window;
    EXPECT_TRUE(sameVoxels(scans.back(), voxelsOf(recentOf(scans, window).occupied())));
    if (window > 1) EXPECT_GT(expected.size(), 20U);
  }
}

TEST(RecentEdges, ArePlainInPaperMode) {
  const auto scans = partsOfACorner(3, 4);
  EdgeConfig paper;
  paper.mode = EdgeMode::kPaper;
  const Voxels expected = expectedEdges(scans, paper);
  EXPECT_FALSE(expected.empty());
  EXPECT_TRUE(sameVoxels(expected, voxelsOf(recentOf(scans, 3, 1, paper).edgeVoxels())));
}

TEST(RecentEdges, DoNotDependOnTheThreads) {
  const auto scans = partsOfACorner(4, 5);
  EXPECT_TRUE(sameVoxels(voxelsOf(recentOf(scans, 4, 1).edgeVoxels()),
                         voxelsOf(recentOf(scans, 4, 3).edgeVoxels())));
}

TEST(RecentEdges, AreGivenAsTheCentroidsThatLieInThem) {
  const auto scans = partsOfACorner(3, 6);
  const RecentEdges recent = recentOf(scans, 3);
  const auto edges = recent.edgeVoxels();
  std::vector<Eigen::Vector3f> expected;
  for (const Eigen::Vector3d& c : centresOf(scans.back())) {
    if (edges.test(voxelAt(c, 1.0 / kSize))) expected.push_back(c.cast<float>());
  }
  EXPECT_FALSE(expected.empty());
  EXPECT_TRUE(expected == recent.edgeCentroids());
}

TEST(RecentEdges, IgnoreWhatIsOutOfRange) {
  const auto scans = partsOfACorner(2, 7);
  RecentEdges recent = recentOf({scans[0]}, 2);
  Centroids centroids = centresOf(scans[1]);
  for (const double x : {kFar * kSize, -kFar * kSize, std::nan("")}) {
    centroids.emplace_back(x, 0.0, 0.0);
  }
  recent.add(centroids);
  EXPECT_TRUE(sameVoxels(scans[1], voxelsOf(recent.occupied())));
  EXPECT_TRUE(sameVoxels(expectedEdges(scans), voxelsOf(recent.edgeVoxels())));
}

TEST(RecentEdges, AreNoneBeforeTheFirstScanAndAfterClear) {
  RecentEdges recent = recentOf({}, 5);
  EXPECT_TRUE(recent.edgeCentroids().empty());
  const auto scans = partsOfACorner(3, 8);
  recent = recentOf({scans[0], scans[1]}, 5);
  recent.clear();
  EXPECT_TRUE(recent.edgeCentroids().empty());
  recent.add(centresOf(scans[2]));
  EXPECT_TRUE(sameVoxels(expectedEdges({scans[2]}), voxelsOf(recent.edgeVoxels())));
}

TEST(RecentEdges, OfTheMapperAreOfLocatedScansOnly) {
  const Walk walk = simulateWalk(sim::WorldName::Corridor, "16", 20, 4);
  Mapper mapper{Config{}};
  const auto scans = voxelScans(walk.sweeps, Config{});
  for (const VoxelScan& scan : scans) ASSERT_TRUE(mapper.process(scan).located());
  const auto edges = mapper.recentEdges().edgeCentroids();
  EXPECT_GT(edges.size(), 100U);
  EXPECT_FALSE(mapper.process(scans.front()).located());
  EXPECT_TRUE(edges == mapper.recentEdges().edgeCentroids());
  mapper.reset();
  EXPECT_TRUE(mapper.recentEdges().edgeCentroids().empty());
}

}  // namespace
}  // namespace edgevox::test
