// SPDX-License-Identifier: BSD-3-Clause
// The incremental map against everything recomputed from all centroids at once.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <gtest/gtest.h>

#include "core/map/block_planes.hpp"
#include "core/map/map_code.hpp"
#include "edgevox/map/map_builder.hpp"
#include "support/reference_extractor.hpp"
#include "support/scans.hpp"

namespace edgevox::test {
namespace {

using Eigen::Vector3d;

constexpr double kSize = kScanMapVoxel;
constexpr double kCoarsest = 3.2;  // [m]

MapBuilder makeMap(MapConfig config, int threads = 1, const EdgeConfig& edges = {}) {
  config.coarsest_voxel = kCoarsest;
  return MapBuilder(kSize, config, edges, threads);
}

MapConfig withLabelEvery(int scans) {
  MapConfig config;
  config.label_every = scans;
  return config;
}

MapConfig withRepresentation(Representation representation) {
  MapConfig config;
  config.representation = representation;
  return config;
}

Voxels parents(Voxels voxels) {
  for (VoxelIndex& v : voxels) v = coarser(v, 1);
  return sorted(std::move(voxels));
}

/// The axis nearest to the normal of a flat voxel, else 3: least variance below a tenth of all, and
/// the middle one large enough for a patch.
int directionOf(const std::vector<Vector3d>& centroids, double size) {
  const auto n = static_cast<double>(centroids.size());
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& c : centroids) mean += c / n;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Vector3d& c : centroids) scatter += (c - mean) * (c - mean).transpose();
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
      (scatter + 2 * 0.09 * size * size * identity) / (n + 2) + 0.02 * 0.02 * identity);
  const Vector3d& e = solver.eigenvalues();
  if (e[0] >= 0.1 * e.sum() || std::pow(e[1] / e[2] / 0.3, 2) <= 0.1) return 3;
  Eigen::Index axis = 0;
  solver.eigenvectors().col(0).cwiseAbs().maxCoeff(&axis);
  return static_cast<int>(axis);
}

/// Of the voxels of a block `count` for each direction of flat ones, by the hash, and all others.
struct Ballot {
  std::array<Voxels, 4> candidates;

  Voxels winners(int count) const {
    Voxels chosen = candidates[3];
    for (size_t direction = 0; direction < 3; ++direction) {
      const auto all = static_cast<double>(candidates[direction].size());
      for (const VoxelIndex& v : candidates[direction]) {
        const double lot = static_cast<double>(voxelHash(v) >> 11) * 0x1.0p-53;
        if (lot * all < count) chosen.push_back(v);
      }
    }
    return chosen;
  }
};

/// What was seen of a voxel of level 1, from far off.
VoxelSide sideOf(const VoxelIndex& v, const std::vector<Vector3d>& centroids) {
  const Vector3d centre = voxelCentre(coarser(v, 3), 16 * kSize);
  VoxelSide side{v, {}, Vector3d::Zero()};
  for (const Vector3d& centroid : centroids) {
    side.moments += Moments::at(centroid - centre, 1.0);
    side.view += (farSensor() - centroid).normalized();
  }
  return side;
}

/// The planes of each block, of all its points at once.
std::map<VoxelIndex, BlockPlanes> planesAtOnce(const std::vector<Centroids>& scans) {
  std::map<VoxelIndex, std::vector<VoxelSide>> sides;
  for (const auto& [v, cell] : accumulate(scans, 1)) {
    sides[coarser(v, 3)].push_back(sideOf(v, cell.centroids));
  }
  std::map<VoxelIndex, BlockPlanes> planes;
  for (const auto& [block, of_block] : sides) {
    planes.try_emplace(block, block, of_block, 2 * kSize, MatchMap(kSize, kCoarsest));
  }
  return planes;
}

void expectPlanes(const std::map<VoxelIndex, BlockPlanes>& expected, const MatchMap& map) {
  std::array<size_t, MatchMap::kCoarsestPlanes + 1> counts{};
  for (const auto& [block, planes] : expected) {
    planes.forEachVoxel([&](int level, const VoxelIndex& v, const VoxelPlanes& of_voxel) {
      const VoxelPlanes* known = map.planes(level).find(v);
      ASSERT_EQ(of_voxel.count, known == nullptr ? 0 : known->count);
      if (known == nullptr) return;
      ++counts[static_cast<size_t>(level)];
      EXPECT_LT((of_voxel.sides[0].normal - known->sides[0].normal).norm(), 1e-3F);
      EXPECT_NEAR(of_voxel.sides[0].offset, known->sides[0].offset, 1e-3F);
    });
  }
  for (int l = MatchMap::kFinestPlanes; l <= MatchMap::kCoarsestPlanes; ++l) {
    EXPECT_EQ(counts[static_cast<size_t>(l)], map.planes(l).count()) << l;
  }
}

Voxels selectedAtOnce(const std::vector<Centroids>& scans, const Voxels& edges,
                      const std::map<VoxelIndex, BlockPlanes>& planes, const MapConfig& config) {
  const Voxels holding_edges = parents(edges);
  const AccumulatedCells cells = accumulate(scans, 1);
  std::map<VoxelIndex, Ballot> blocks;
  for (const VoxelIndex& v : withHits(cells, config.min_hits)) {
    const std::vector<Vector3d>& centroids = cells.at(v).centroids;
    if (planes.at(coarser(v, 3)).explains(sideOf(v, centroids))) continue;
    int direction = directionOf(centroids, 2 * kSize);
    const bool edge = std::binary_search(holding_edges.begin(), holding_edges.end(), v);
    if (edge) direction = 3;
    if (direction == 3 && !edge) continue;
    blocks[coarser(v, 3)].candidates[static_cast<size_t>(direction)].push_back(v);
  }
  Voxels selected;
  for (const auto& [block, ballot] : blocks) {
    const Voxels chosen = ballot.winners(config.anchors);
    selected.insert(selected.end(), chosen.begin(), chosen.end());
  }
  return sorted(std::move(selected));
}

Voxels selectedIn(const MapBuilder& map, const AccumulatedCells& cells) {
  Voxels selected;
  for (const auto& entry : cells) {
    const uint32_t slot = map.matchMap().surfaces().slotOf(entry.first);
    if (map.moments().cell(slot).selected) selected.push_back(entry.first);
  }
  return selected;
}

void expectMapOf(const std::vector<Centroids>& scans, const MapBuilder& map,
                 const MapConfig& config) {
  const Voxels hit = withHits(accumulate(scans, 0), config.min_hits);
  EXPECT_TRUE(sameVoxels(hit, voxelsOf(map.hitVoxels())));
  const Voxels edges = labelledAtOnce(hit);
  EXPECT_TRUE(sameVoxels(edges, voxelsOf(map.edgeVoxels())));
  const auto planes = planesAtOnce(scans);
  expectPlanes(planes, map.matchMap());
  const Voxels selected = selectedAtOnce(scans, edges, planes, config);
  EXPECT_TRUE(sameVoxels(selected, selectedIn(map, accumulate(scans, 1))));
  EXPECT_EQ(selected.size(), map.matchMap().surfaces().selectedCount());
}

MapBuilder mapOf(const std::vector<Centroids>& scans, const MapConfig& config, int threads = 1) {
  MapBuilder map = makeMap(config, threads);
  for (const Centroids& scan : scans) map.insert(scan, farSensor());
  map.label();
  return map;
}

TEST(Labels, AreThoseOfTheWholeMapHoweverBatched) {
  const auto scans = randomScans(1, 7);
  for (const int every : {1, 2, 5}) {
    SCOPED_TRACE(every);
    expectMapOf(scans, mapOf(scans, withLabelEvery(every)), withLabelEvery(every));
  }
}

TEST(Labels, AreThoseOfTheWholeMapAfterEveryScan) {
  const auto scans = randomScans(2, 7);
  const MapConfig config = withLabelEvery(1);
  MapBuilder map = makeMap(config);
  Voxels before;
  size_t lost = 0;
  for (size_t scan = 0; scan < scans.size(); ++scan) {
    map.insert(scans[scan], farSensor());
    expectMapOf({scans.begin(), scans.begin() + static_cast<long>(scan) + 1}, map, config);
    lost += difference(before, voxelsOf(map.edgeVoxels())).size();
    before = voxelsOf(map.edgeVoxels());
  }
  RecordProperty("edges", static_cast<int>(before.size()));
  RecordProperty("labels_lost", static_cast<int>(lost));
  EXPECT_GT(before.size(), 1000U);
  EXPECT_GT(lost, 100U);  // so that taking labels back is put to the test
}

TEST(Labels, ComeEveryFewScans) {
  const auto scans = randomScans(3, 4);
  MapBuilder map = makeMap(withLabelEvery(4));
  for (int scan = 0; scan < 3; ++scan) map.insert(scans[static_cast<size_t>(scan)], farSensor());
  EXPECT_EQ(0U, map.edgeVoxels().voxelCount());
  map.insert(scans[3], farSensor());
  EXPECT_GT(map.edgeVoxels().voxelCount(), 100U);
}

TEST(Labels, DoNotDependOnTheThreads) {
  const auto scans = randomScans(4, 4);
  const Voxels expected = voxelsOf(mapOf(scans, {}, 1).edgeVoxels());
  EXPECT_TRUE(sameVoxels(expected, voxelsOf(mapOf(scans, {}, 2).edgeVoxels())));
}

Centroids centresOf(const Voxels& voxels) {
  Centroids centres;
  for (const VoxelIndex& v : voxels) centres.push_back(voxelCentre(v, kSize));
  return centres;
}

EdgeConfig withNeighbours(int neighbours, EdgeMode mode = EdgeMode::kDefault) {
  EdgeConfig config;
  config.mode = mode;
  config.map_neighbours = neighbours;
  return config;
}

TEST(Labels, FollowSingleVoxelsOverTheirWholeReach) {
  MapConfig config = withLabelEvery(1);
  config.min_hits = 1;
  for (const EdgeConfig& edges : {withNeighbours(0), withNeighbours(2), withNeighbours(8),
                                  withNeighbours(8, EdgeMode::kPaper)}) {
    Random random(17);
    MapBuilder map = makeMap(config, 1, edges);
    map.insert(centresOf(randomCloud(random, 14, 0.1)), farSensor());  // across eight blocks
    for (int i = 0; i < 300; ++i) {
      map.insert(centresOf({random.voxelIn(-7, 6)}), farSensor());
      const Voxels hit = voxelsOf(map.hitVoxels());
      ASSERT_TRUE(sameVoxels(labelledAtOnce(hit, edges), voxelsOf(map.edgeVoxels())));
    }
    EXPECT_GT(map.edgeVoxels().voxelCount(), 10U);
  }
}

TEST(Labels, OneHitMayBeEnough) {
  const auto scans = randomScans(5, 3);
  MapConfig config;
  config.min_hits = 1;
  expectMapOf(scans, mapOf(scans, config), config);
}

TEST(Anchors, MayBeNoneOrAll) {
  const auto scans = randomScans(6, 3);
  for (const int anchors : {0, 1, 1000}) {
    MapConfig config;
    config.anchors = anchors;
    expectMapOf(scans, mapOf(scans, config), config);
  }
}

TEST(Hits, CountScansNotCentroids) {
  MapBuilder map = makeMap({});
  const Centroids three = {{1.01, 0.01, 0.01}, {1.02, 0.01, 0.01}, {1.03, 0.01, 0.01}};
  const VoxelIndex v{10, 0, 0};
  map.insert(three, farSensor());
  EXPECT_FALSE(map.hitVoxels().test(v));
  map.insert({}, farSensor());
  EXPECT_FALSE(map.hitVoxels().test(v));
  map.insert({three[0]}, farSensor());
  EXPECT_TRUE(map.hitVoxels().test(v));
  EXPECT_EQ(3U, map.scans());
  const uint32_t slot = map.matchMap().surfaces().slotOf({5, 0, 0});
  EXPECT_EQ(2, map.moments().cell(slot).hits);
  EXPECT_EQ(4U, map.moments().cell(slot).count);
}

TEST(Centroid, IsTheMeanOfAllThatFellIn) {
  const auto scans = randomScans(7, 4);
  const MapBuilder map = mapOf(scans, {});
  for (const auto& [v, cell] : accumulate(scans, 0)) {
    Vector3d mean = Vector3d::Zero();
    for (const Vector3d& centroid : cell.centroids) mean += centroid;
    mean /= static_cast<double>(cell.centroids.size());
    ASSERT_LT((map.centroid(v) - mean).norm(), 1e-7);
  }
}

TEST(Levels, HoldTheBitsOfAllCentroids) {
  const auto scans = randomScans(8, 2);
  const MapBuilder map = mapOf(scans, {});
  ASSERT_EQ(6, map.levels());  // 0.1 to 3.2 m
  for (int level = 1; level < map.levels(); ++level) {
    EXPECT_DOUBLE_EQ(kSize * (1 << level), map.voxelSize(level));
    const Voxels all = withHits(accumulate(scans, level), 1);
    EXPECT_TRUE(sameVoxels(all, voxelsOf(map.matchMap().occupied(level)))) << level;
  }
}

TEST(Representations, AllSelectsWhatWasHitOftenEnough) {
  const auto scans = randomScans(12, 4);
  const MapConfig config = withRepresentation(Representation::kAll);
  MapBuilder map = makeMap(config);
  for (const Centroids& scan : scans) map.insert(scan, farSensor());
  const AccumulatedCells cells = accumulate(scans, 1);
  const Voxels before = selectedIn(map, cells);
  EXPECT_TRUE(sameVoxels(withHits(cells, config.min_hits), before));
  map.label();  // for the edges alone; the selection stays
  EXPECT_GT(map.edgeVoxels().voxelCount(), 100U);
  EXPECT_TRUE(sameVoxels(before, selectedIn(map, cells)));
}

TEST(Representations, RandomSelectsAsManyAsSparse) {
  const auto scans = randomScans(13, 4, {140, 110, 60});
  const MapBuilder sparse = mapOf(scans, withRepresentation(Representation::kSparse));
  const MapBuilder random = mapOf(scans, withRepresentation(Representation::kRandom));
  const auto expected = static_cast<double>(sparse.matchMap().surfaces().selectedCount());
  const auto actual = static_cast<double>(random.matchMap().surfaces().selectedCount());
  RecordProperty("sparse", static_cast<int>(expected));
  RecordProperty("random", static_cast<int>(actual));
  EXPECT_NEAR(expected, actual, 3 * std::sqrt(expected));
  const AccumulatedCells cells = accumulate(scans, 1);
  const Voxels often = withHits(cells, MapConfig{}.min_hits);
  EXPECT_TRUE(difference(selectedIn(random, cells), often).empty());
}

TEST(Representations, SparsePacksSmallerThanAll) {
  const auto scans = randomScans(14, 5);
  const MapBuilder sparse = mapOf(scans, withRepresentation(Representation::kSparse));
  const MapBuilder all = mapOf(scans, withRepresentation(Representation::kAll));
  const size_t sparse_bytes = encoded(sparse.completeMap(), Representation::kSparse).size();
  const size_t all_bytes = encoded(all.completeMap(), Representation::kAll).size();
  RecordProperty("sparse_bytes", static_cast<int>(sparse_bytes));
  RecordProperty("all_bytes", static_cast<int>(all_bytes));
  EXPECT_GT(static_cast<double>(all_bytes), 1.2 * static_cast<double>(sparse_bytes));
  EXPECT_LT(sparse_bytes, sparse.bytes() / 10);
}

TEST(Clear, ReturnsToANewMap) {
  const auto first = randomScans(15, 3);
  const auto second = randomScans(16, 5);
  MapBuilder map = mapOf(first, {});
  map.insert({{1e9, 0, 0}}, farSensor());
  map.clear();
  EXPECT_TRUE(map.empty());
  EXPECT_EQ(0U, map.ignoredCentroids());
  EXPECT_EQ(makeMap({}).bytes(), map.bytes());
  EXPECT_EQ(makeMap({}).levels(), map.levels());

  for (const Centroids& scan : second) map.insert(scan, farSensor());
  map.label();
  expectMapOf(second, map, {});
  EXPECT_EQ(encoded(mapOf(second, {}).completeMap(), Representation::kSparse),
            encoded(map.completeMap(), Representation::kSparse));
}

TEST(OutOfRange, CentroidsAreIgnoredAndCounted) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const double limit = kIndexLimit * kSize;
  Centroids bad;
  for (const double value : {nan, inf, -inf, 1e9, -1e30, limit, -limit - kSize}) {
    for (int axis = 0; axis < 3; ++axis) {
      Vector3d centroid(1, 2, 3);
      centroid[axis] = value;
      bad.push_back(centroid);
    }
  }
  MapBuilder map = makeMap(withLabelEvery(1));
  map.insert(bad, farSensor());
  map.insert(bad, farSensor());
  EXPECT_EQ(2 * bad.size(), map.ignoredCentroids());
  EXPECT_EQ(0U, map.hitVoxels().voxelCount());
  EXPECT_EQ(0U, map.matchMap().surfaces().slotCount());
}

TEST(OutOfRange, VoxelsNearTheLimitAreKept) {
  const double near = (kIndexLimit - 2) * kSize;
  MapConfig config;
  config.confirm_within = 0;
  MapBuilder map = makeMap(config);
  for (int scan = 0; scan < 2; ++scan)
    map.insert({{near, near, near}, {-near, -near, -near}}, farSensor());
  EXPECT_EQ(0U, map.ignoredCentroids());
  EXPECT_EQ(2U, map.hitVoxels().voxelCount());
}

}  // namespace
}  // namespace edgevox::test
