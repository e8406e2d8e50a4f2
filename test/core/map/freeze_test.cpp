// SPDX-License-Identifier: BSD-3-Clause
// Places out of reach are packed; they must match, label and come back as if they were not.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <gtest/gtest.h>

#include "edgevox/map/map_builder.hpp"
#include "support/random.hpp"
#include "support/reference_extractor.hpp"
#include "support/scans.hpp"
#include "support/voxel_sets.hpp"

namespace edgevox::test {
namespace {

using Eigen::Vector3d;

constexpr double kSize = kScanMapVoxel;
constexpr double kRange = 10.0;  // [m]
const Vector3d kFarAway(500.0, 20.0, 0.0);

MapConfig freezingAfter(int scans) {
  MapConfig config;
  config.coarsest_voxel = 3.2;
  config.freeze_after = scans;
  return config;
}

MapBuilder makeMap(const MapConfig& config, int threads = 1) {
  return MapBuilder(kSize, config, EdgeConfig{}, threads, kRange);
}

/// Random scans of a room about `place`.
class Visitor {
 public:
  void visit(const Vector3d& place, int scans, MapBuilder& map) {
    for (int i = 0; i < scans; ++i) {
      Centroids scan = scans_[next_++ % scans_.size()];
      for (Vector3d& point : scan) point += place;
      map.insert(scan, place);
    }
  }

 private:
  std::vector<Centroids> scans_ = randomScans(41, 12);
  size_t next_ = 0;
};

/// All that later scans are matched to.
struct Matched {
  explicit Matched(const MapBuilder& map)
      : hit(voxelsOf(map.hitVoxels())), edges(voxelsOf(map.edgeVoxels())) {
    for (int l = 1; l < map.levels(); ++l) occupied.push_back(voxelsOf(map.matchMap().occupied(l)));
    const SurfaceLevel& level = map.matchMap().surfaces();
    for (const VoxelIndex& v : occupied[0]) {
      const auto around = level.around(v, false);
      if (around.count == 0 || around.slots[0] != level.slotOf(v)) continue;
      for (uint32_t s = around.slots[0]; s != Surface::kNone; s = level.surface(s).back_surface) {
        surfaces[v].push_back(level.surface(s));
      }
    }
  }

  Voxels hit;
  Voxels edges;
  std::vector<Voxels> occupied;
  std::map<VoxelIndex, std::vector<Surface>> surfaces;
};

void expectSameSurfaces(const Matched& expected, const Matched& actual) {
  for (const auto& [v, sides] : expected.surfaces) {
    const auto found = actual.surfaces.find(v);
    ASSERT_NE(actual.surfaces.end(), found);
    ASSERT_EQ(sides.size(), found->second.size());
    for (size_t i = 0; i < sides.size(); ++i) {
      ASSERT_EQ(sides[i].mean, found->second[i].mean);
      ASSERT_EQ(sides[i].information, found->second[i].information);
      ASSERT_EQ(sides[i].side, found->second[i].side);
    }
  }
}

TEST(Freezing, KeepsAllThatScansAreMatchedTo) {
  MapBuilder map = makeMap(freezingAfter(20));
  Visitor visitor;
  visitor.visit(Vector3d::Zero(), 20, map);
  map.label();
  const Matched before(map);
  ASSERT_LT(1000U, before.edges.size());
  ASSERT_LT(200U, before.surfaces.size());
  std::map<VoxelIndex, Vector3d> centroids;
  for (const VoxelIndex& v : before.hit) centroids[v] = map.centroid(v);

  visitor.visit(kFarAway, 5, map);
  EXPECT_GT(before.hit.size() / 2, map.frozenVoxels());
  visitor.visit(kFarAway, 25, map);
  EXPECT_LT(5U, map.frozenRegions());
  EXPECT_EQ(before.hit.size(), map.frozenVoxels());
  const Matched after(map);
  EXPECT_TRUE(difference(before.hit, after.hit).empty());
  EXPECT_TRUE(difference(before.edges, after.edges).empty());
  for (size_t l = 0; l < before.occupied.size(); ++l) {
    EXPECT_TRUE(difference(before.occupied[l], after.occupied[l]).empty()) << l;
  }
  expectSameSurfaces(before, after);
  for (const VoxelIndex& v : before.hit) {
    const bool edge = map.edgeVoxels().test(v);
    const Vector3d expected = edge ? centroids[v] : voxelCentre(v, kSize);
    const double step = edge ? kSize / 256 : 0.0;
    ASSERT_LE((map.centroid(v) - expected).cwiseAbs().maxCoeff(), 0.5 * step + 1e-6);
  }
}

TEST(Freezing, GivesMemoryBack) {
  size_t bytes[2];
  for (const int after : {0, 20}) {
    MapBuilder map = makeMap(freezingAfter(after));
    Visitor visitor;
    for (int place = 0; place < 6; ++place) visitor.visit(place * kFarAway, 25, map);
    bytes[after == 0 ? 0 : 1] = map.bytes();
  }
  RecordProperty("kept", static_cast<int>(bytes[0]));
  RecordProperty("frozen", static_cast<int>(bytes[1]));
  EXPECT_LT(2 * bytes[1], bytes[0]);
}

TEST(Freezing, WhatComesBackKeepsItsSelection) {
  MapBuilder map = makeMap(freezingAfter(20));
  Visitor visitor;
  visitor.visit(Vector3d::Zero(), 20, map);
  visitor.visit(kFarAway, 30, map);
  const Matched before(map);
  const size_t frozen = map.frozenRegions();
  // One point beside a corner of eight regions: all are thawed.
  map.insert({{0.05, 0.05, 0.05}, {0.05, 0.05, 0.06}, {0.05, 0.06, 0.06}}, Vector3d::Zero());
  EXPECT_LT(map.frozenRegions(), frozen);
  EXPECT_LT(0U, map.thawedRegions());
  map.label();
  const Matched after(map);
  EXPECT_TRUE(difference(before.hit, after.hit).empty());
  expectSameSurfaces(before, after);
  EXPECT_EQ(before.surfaces.size(), after.surfaces.size());
  visitor.visit(Vector3d::Zero(), 20, map);
  EXPECT_EQ(0U, std::count_if(before.hit.begin(), before.hit.end(), [&](const VoxelIndex& v) {
              return v.x < 1000 && !map.hitVoxels().test(v);
            }));
  map.label();
  EXPECT_TRUE(sameVoxels(labelledAtOnce(voxelsOf(map.hitVoxels())), voxelsOf(map.edgeVoxels())));
}

using LevelAndVoxel = std::pair<int, VoxelIndex>;

std::map<LevelAndVoxel, VoxelPlanes> planesIn(const MapBuilder& map) {
  std::map<LevelAndVoxel, VoxelPlanes> planes;
  for (int l = MatchMap::kFinestPlanes; l <= MatchMap::kCoarsestPlanes; ++l) {
    map.matchMap().planes(l).forEachVoxel([&](const VoxelIndex& v, const VoxelPlanes& of_voxel) {
      planes[{l, v}] = of_voxel;
    });
  }
  return planes;
}

/// Scans of a floor that is 5 m wide, and of a wall at its end.
class Hall {
 public:
  /// Of a square of both. `lift`: of the floor [m].
  void scan(int scans, double from, double to, double lift, MapBuilder& map) {
    for (int i = 0; i < scans; ++i) {
      Centroids scan;
      for (int k = 0; k < 3000; ++k) {
        const double x = random_.uniform(from, to);
        const double y = random_.uniform(from, to);
        const double noise = 0.005 * random_.normal();
        scan.push_back(k % 2 == 0 ? Vector3d(x, y, 0.23 + lift + noise)
                                  : Vector3d(x, 0.23 + noise, y));
      }
      map.insert(scan, {2.5, 2.5, 1.5});
    }
  }

 private:
  Random random_{13};
};

TEST(Freezing, KeepsPlanesAlsoWhereScansComeBackToACornerOfThem) {
  constexpr double kFrom = 1.7;  // a corner of a voxel of level 4 [m]
  constexpr double kTo = 2.3;
  MapBuilder map = makeMap(freezingAfter(20));
  Hall hall;
  hall.scan(10, 0.02, 5.0, 0.0, map);
  const auto before = planesIn(map);
  ASSERT_LT(4, std::count_if(before.begin(), before.end(), [](const auto& of_voxel) {
              return of_voxel.first.first == MatchMap::kCoarsestPlanes;
            }));
  Visitor().visit(kFarAway, 40, map);
  ASSERT_LT(5U, map.frozenRegions());
  for (int scan = 0; scan < 30; ++scan) {  // thrice as many points as in the voxel before
    hall.scan(1, kFrom, kTo, 0.02, map);
    const auto after = planesIn(map);
    for (const auto& [at, planes] : before) {
      const double x = at.second.x * map.voxelSize(at.first);
      if (at.first < 4 && x > kFrom - 0.2 && x < kTo) continue;  // may be seen as a whole
      const auto found = after.find(at);
      ASSERT_NE(after.end(), found) << scan << ", level " << at.first;
      ASSERT_EQ(planes.count, found->second.count);
      ASSERT_EQ(planes.sides[0].normal, found->second.sides[0].normal) << scan;
      ASSERT_EQ(planes.sides[0].offset, found->second.sides[0].offset) << scan;
    }
  }
  EXPECT_LT(0U, map.thawedRegions());
  hall.scan(30, 0.02, 5.0, 0.02, map);  // a new floor: now they give way
  const VoxelIndex middle = voxelAt(Vector3d(2.5, 2.5, 0.23), 1.0 / map.voxelSize(4));
  const VoxelPlanes* floor = map.matchMap().planes(4).find(middle);
  ASSERT_NE(nullptr, floor);
  EXPECT_NEAR(before.at({4, middle}).sides[0].offset + 0.02F, floor->sides[0].offset, 0.002F);
}

/// A walk to and fro between places that overlap, with a map that freezes whatever it may.
void walkToAndFro(MapBuilder& map, int label_checks) {
  Random random(5);
  Visitor visitor;
  for (int i = 0; i < 60; ++i) {
    const double way = 30.0 * std::abs(std::sin(0.22 * i));
    const Vector3d place(way, 0.3 * way, random.normal());
    visitor.visit(place, 1, map);
    if (label_checks == 0 || i % (60 / label_checks) != 30 / label_checks) continue;
    map.label();
    const Voxels hit = voxelsOf(map.hitVoxels());
    ASSERT_TRUE(sameVoxels(labelledAtOnce(hit), voxelsOf(map.edgeVoxels()))) << i;
  }
}

MapBuilder mapThatFreezesOften(Representation representation, int min_hits, int clear_after = 0,
                               int threads = 1) {
  MapConfig config = freezingAfter(2);
  config.representation = representation;
  config.min_hits = min_hits;
  config.clear_after = clear_after;
  config.label_every = 2;
  return MapBuilder(kSize, config, EdgeConfig{}, threads, 0.1);
}

TEST(Freezing, LabelsAreThoseOfTheWholeMap) {
  for (const int min_hits : {1, 2}) {
    MapBuilder map = mapThatFreezesOften(Representation::kSparse, min_hits);
    walkToAndFro(map, 4);
    RecordProperty("thawed_" + std::to_string(min_hits), static_cast<int>(map.thawedRegions()));
    EXPECT_LT(50U, map.thawedRegions());
  }
}

TEST(Freezing, ChangesNoVoxelIfOneHitIsEnough) {
  MapBuilder map = mapThatFreezesOften(Representation::kSparse, 1);
  MapConfig config = freezingAfter(0);
  config.min_hits = 1;
  config.label_every = 2;
  MapBuilder whole = makeMap(config);
  walkToAndFro(map, 0);
  walkToAndFro(whole, 0);
  EXPECT_EQ(0U, whole.thawedRegions());
  EXPECT_TRUE(sameVoxels(voxelsOf(whole.hitVoxels()), voxelsOf(map.hitVoxels())));
  EXPECT_TRUE(sameVoxels(voxelsOf(whole.edgeVoxels()), voxelsOf(map.edgeVoxels())));
  for (int l = 1; l < map.levels(); ++l) {
    EXPECT_TRUE(
        sameVoxels(voxelsOf(whole.matchMap().occupied(l)), voxelsOf(map.matchMap().occupied(l))));
  }
}

/// What is saved has all voxels, with their centroids.
void expectComplete(const MapBuilder& map, const MatchMap& complete, bool edges_alone) {
  EXPECT_TRUE(sameVoxels(voxelsOf(map.hitVoxels()), voxelsOf(complete.hitVoxels())));
  EXPECT_EQ(map.hitVoxelCount(), complete.hitVoxels().voxelCount());
  EXPECT_EQ(map.edgeVoxels().voxelCount(), complete.edges().size());
  EXPECT_EQ(edges_alone, !complete.besideEdges().empty());
  const auto isIn = [](const VoxelIndex& v, const Eigen::Vector3f& centroid) {
    return (centroid.cast<double>() - voxelCentre(v, kSize)).cwiseAbs().maxCoeff() <
           0.5 * kSize + 1e-4;
  };
  for (const EdgeVoxel& edge : complete.edges()) {
    ASSERT_TRUE(complete.hitVoxels().test(edge.voxel));
    ASSERT_TRUE(isIn(edge.voxel, edge.centroid));
    ASSERT_NEAR(1.0, edge.direction.norm(), 1e-3);
  }
  for (const VoxelPoint& beside : complete.besideEdges()) {
    ASSERT_TRUE(complete.hitVoxels().test(beside.voxel));
    ASSERT_TRUE(isIn(beside.voxel, beside.centroid));
  }
}

TEST(Freezing, WorksInEveryRepresentationAndWithClearing) {
  for (const auto representation : {Representation::kSparse, Representation::kAll,
                                    Representation::kRandom, Representation::kEdges}) {
    for (const int clear_after : {0, 2}) {
      MapBuilder map = mapThatFreezesOften(representation, 2, clear_after);
      walkToAndFro(map, 1);
      map.prepareAll();
      EXPECT_LT(20U, map.thawedRegions());
      EXPECT_LT(20U, map.frozenRegions());
      EXPECT_EQ(clear_after > 0, map.clearedVoxels() > 0);
      map.label();
      expectComplete(map, map.completeMap(), representation == Representation::kEdges);
    }
  }
}

TEST(Freezing, DoesNotDependOnTheThreads) {
  MapBuilder one = mapThatFreezesOften(Representation::kSparse, 2, 2, 1);
  MapBuilder two = mapThatFreezesOften(Representation::kSparse, 2, 2, 2);
  walkToAndFro(one, 0);
  walkToAndFro(two, 0);
  const Matched a(one);
  const Matched b(two);
  EXPECT_TRUE(sameVoxels(a.hit, b.hit));
  EXPECT_TRUE(sameVoxels(a.edges, b.edges));
  expectSameSurfaces(a, b);
  expectSameSurfaces(b, a);
  EXPECT_EQ(one.bytes(), two.bytes());
}

TEST(Freezing, EndsWithTheMap) {
  MapBuilder map = mapThatFreezesOften(Representation::kSparse, 2);
  walkToAndFro(map, 0);
  map.clear();
  EXPECT_EQ(0U, map.frozenRegions());
  EXPECT_EQ(0U, map.frozenVoxels());
  EXPECT_EQ(makeMap(freezingAfter(0)).bytes(), map.bytes());
}

TEST(PackedCell, KeepsWhatASurfaceIsMadeOf) {
  Random random(7);
  for (int i = 0; i < 1000; ++i) {
    MomentCell cell;
    cell.count = 1 + static_cast<uint32_t>(random.uniform(0, i < 500 ? 10 : 80000));
    cell.hits = static_cast<uint16_t>(random.uniform(0, 300));
    cell.flat_axis = static_cast<int8_t>(random.uniform(-1, 2.99));
    cell.anchor = random.chance(0.5);
    cell.is_back = random.chance(0.5);
    cell.selected = random.chance(0.5);
    const double n = cell.count;
    const Vector3d mean = random.vectorIn(-0.5, 0.5) * kSize;
    const Vector3d spread = random.vectorIn(-0.3, 0.3) * kSize;
    const Vector3d view = random.vectorIn(-0.5, 0.5);
    for (size_t k = 0; k < 3; ++k) {
      const auto a = static_cast<Eigen::Index>(k);
      const auto b = static_cast<Eigen::Index>((k + 1) % 3);
      cell.sum[k] = static_cast<float>(n * mean[a]);
      cell.outer[k] = static_cast<float>(n * (spread[a] * spread[a] + mean[a] * mean[a]));
      cell.outer[k + 3] = static_cast<float>(n * (spread[a] * spread[b] + mean[a] * mean[b]));
      cell.view[k] = static_cast<float>(n * view[a]);
    }
    const MomentCell again = PackedCell(cell, kSize).unpacked(mean, kSize);
    ASSERT_EQ(std::min(cell.count, 65535U), again.count);
    ASSERT_EQ(std::min<int>(cell.hits, 255), again.hits);
    ASSERT_EQ(cell.flat_axis, again.flat_axis);
    ASSERT_EQ(cell.anchor, again.anchor);
    ASSERT_EQ(cell.is_back, again.is_back);
    ASSERT_EQ(cell.selected, again.selected);
    for (size_t k = 0; k < 6; ++k) {
      ASSERT_NEAR(cell.outer[k] / n, again.outer[k] / again.count, 7e-5 * kSize * kSize);
    }
    for (size_t k = 0; k < 3; ++k) {
      ASSERT_NEAR(cell.sum[k] / n, again.sum[k] / again.count, 1e-6 * kSize);
      ASSERT_NEAR(cell.view[k] / n, again.view[k] / again.count, 0.5 / 127 + 1e-6);
    }
  }
}

TEST(Memory, IsMadeByFreezingBeforePlacesAreRefused) {
  constexpr int kMegabytes = 8;
  MapConfig config = freezingAfter(1000000);  // not by themselves
  config.memory = kMegabytes;
  MapBuilder map = makeMap(config);
  Visitor visitor;
  const Vector3d step(40.0, 20.0, 0.0);
  size_t places = 0;
  for (; map.frozenRegions() == 0 && places < 30; ++places) {
    visitor.visit(static_cast<double>(places) * step, 12, map);
  }
  const size_t until_frozen = places;
  for (; places < 2 * until_frozen; ++places) {
    visitor.visit(static_cast<double>(places) * step, 12, map);
    ASSERT_FALSE(map.isFull());
  }
  EXPECT_EQ(0U, map.centroidsPastMemory());
  RecordProperty("places", static_cast<int>(until_frozen));
  RecordProperty("bytes", static_cast<int>(map.bytes()));
  EXPECT_GT(1.2e6 * kMegabytes, static_cast<double>(map.bytes()));
  for (; !map.isFull() && places < 300; ++places) {
    visitor.visit(static_cast<double>(places) * step, 2, map);
  }
  RecordProperty("places_in_all", static_cast<int>(places));
  EXPECT_TRUE(map.isFull());
  EXPECT_LT(0U, map.centroidsPastMemory());
  EXPECT_LT(3 * until_frozen, places);
  EXPECT_NE(std::string::npos, fullText(config).find("frozen"));
}

}  // namespace
}  // namespace edgevox::test
