// SPDX-License-Identifier: BSD-3-Clause
// What the extractor finds on shapes whose edges are known.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "edgevox/edges/edge_extractor.hpp"
#include "support/reference_extractor.hpp"
#include "support/scenes.hpp"

namespace edgevox::test {
namespace {

constexpr double kNoSupport = 0.0;
const EdgeConfig kDefaults;
const EdgeConfig kPaper = [] {
  EdgeConfig config;
  config.mode = EdgeMode::kPaper;
  return config;
}();

BitGrid<16> edgesOf(const Scene& scene, const EdgeConfig& config, double support) {
  const auto occupied = gridOf<16>(scene.voxels);
  BitGrid<16> edges;
  EdgeLabeller<16>(config, {config.scan.ratio, support}, 1).label(occupied, occupied, edges);
  return edges;
}

/// How many of some voxels are labelled as edges.
struct Tally {
  int edges = 0;
  int voxels = 0;

  void count(bool edge) {
    edges += edge ? 1 : 0;
    ++voxels;
  }
  double share() const { return static_cast<double>(edges) / voxels; }
};

void record(const std::string& name, const Tally& tally) {
  ::testing::Test::RecordProperty(
      name, std::to_string(tally.edges) + " of " + std::to_string(tally.voxels));
}

/// Voxels within half a voxel of the crease, and those of its faces more than 5 voxels off; both
/// more than 6 voxels from the rims.
struct CreaseTally {
  Tally on_crease;
  Tally on_faces;
};

CreaseTally tallyDihedrals(double angle, const EdgeConfig& config, double support) {
  Random random(7);
  CreaseTally tally;
  for (int i = 0; i < 20; ++i) {
    const Scene scene = dihedralScene(random, angle, 40, 18);
    const auto edges = edgesOf(scene, config, support);
    for (const VoxelIndex& v : scene.voxels) {
      if (scene.rimDistance(v) < 6) continue;
      const double distance = scene.creaseDistance(v);
      if (distance <= 0.5) tally.on_crease.count(edges.test(v));
      if (distance > 5) tally.on_faces.count(edges.test(v));
    }
  }
  return tally;
}

/// Voxels of planes more than 5 from the rim, and those less than 2 from it.
struct PlaneTally {
  Tally inside;
  Tally rim;
};

PlaneTally tallyPlanes(double sigma, const EdgeConfig& config, double support) {
  Random random(8);
  PlaneTally tally;
  for (int i = 0; i < 15; ++i) {
    const Scene scene = planeScene(random, 45, sigma);
    const auto edges = edgesOf(scene, config, support);
    for (const VoxelIndex& v : scene.voxels) {
      const double distance = scene.rimDistance(v);
      if (distance > 5) tally.inside.count(edges.test(v));
      if (distance < 2) tally.rim.count(edges.test(v));
    }
  }
  return tally;
}

Tally tallyCorners(const EdgeConfig& config, double support) {
  Random random(9);
  Tally tally;
  for (int i = 0; i < 60; ++i) {
    const Scene scene = cornerScene(random, 14);
    const auto edges = edgesOf(scene, config, support);
    for (const VoxelIndex& v : scene.voxels) {
      if (scene.cornerDistance(v) <= 1) tally.count(edges.test(v));
    }
  }
  return tally;
}

Tally tallyAll(const std::vector<Scene>& scenes, const EdgeConfig& config, double support) {
  Tally tally;
  for (const Scene& scene : scenes) {
    const auto edges = edgesOf(scene, config, support);
    for (const VoxelIndex& v : scene.voxels) tally.count(edges.test(v));
  }
  return tally;
}

std::vector<Scene> rods() {
  Random random(10);
  std::vector<Scene> scenes;
  for (int i = 0; i < 15; ++i) scenes.push_back(rodScene(random, 30));
  return scenes;
}

std::vector<Scene> rings() {
  Random random(11);
  std::vector<Scene> scenes;
  for (int i = 0; i < 10; ++i) scenes.push_back(ringScene(random, 3, 24));
  return scenes;
}

TEST(Dihedral, RightAnglesAreAlwaysFound) {
  for (const double support : {kNoSupport, 0.3}) {
    const CreaseTally tally = tallyDihedrals(90, kDefaults, support);
    record("on_crease_support_" + std::to_string(support), tally.on_crease);
    EXPECT_GT(tally.on_crease.voxels, 300);
    EXPECT_EQ(tally.on_crease.voxels, tally.on_crease.edges);
    EXPECT_EQ(0, tally.on_faces.edges);
  }
}

TEST(Dihedral, RightAnglesAreFoundWithTheSupportOfMaps) {
  const CreaseTally tally = tallyDihedrals(90, kDefaults, 0.5);
  record("on_crease", tally.on_crease);
  EXPECT_GE(tally.on_crease.share(), 0.99);
  EXPECT_EQ(0, tally.on_faces.edges);
}

template <int kSide>
void expectThinned(const Voxels& candidates, const Voxels& targets, int neighbours) {
  const auto thinned = gridOf<16>(thinnedAtOnce(candidates, neighbours));
  const auto target = gridOf<16>(targets);
  Voxels expected;
  for (const VoxelIndex& v : candidates) {
    if (!target.test(v) || thinned.test(v)) expected.push_back(v);
  }
  auto edges = gridOf<kSide>(candidates);  // all of them, to begin with
  thinEdges<kSide>(gridOf<kSide>(candidates), gridOf<kSide>(targets), neighbours, edges);
  EXPECT_TRUE(sameVoxels(expected, voxelsOf(edges))) << kSide << " " << neighbours;
}

TEST(Thinning, IsThatOfEachVoxelByItself) {
  Random random(18);
  for (const double density : {0.1, 0.3, 0.7, 1.0}) {
    const Voxels candidates = randomCloud(random, 40, density);
    Voxels targets;
    for (const VoxelIndex& v : candidates) {
      if (random.chance(0.7)) targets.push_back(v);
    }
    for (const int neighbours : {0, 1, 8, 25, 26}) {
      expectThinned<8>(candidates, targets, neighbours);
      expectThinned<16>(candidates, targets, neighbours);
      expectThinned<32>(candidates, targets, neighbours);
    }
  }
}

/// Labels as the accumulated map has them.
BitGrid<16> mapEdgesOf(const Scene& scene) {
  const auto occupied = gridOf<16>(scene.voxels);
  BitGrid<16> candidates, edges;
  EdgeLabeller<16>(kDefaults, kDefaults.map, 1).label(occupied, occupied, candidates);
  thinEdges(candidates, occupied, kDefaults.map_neighbours, edges);
  return edges;
}

TEST(Dihedral, EdgesOfTheMapKeepToRightAngles) {
  Random random(7);
  Tally on_crease, near_crease;
  for (int i = 0; i < 20; ++i) {
    const Scene scene = dihedralScene(random, 90, 40, 18);
    const auto edges = mapEdgesOf(scene);
    for (const VoxelIndex& v : scene.voxels) {
      if (scene.rimDistance(v) < 6) continue;
      const double distance = scene.creaseDistance(v);
      if (distance <= 0.5) on_crease.count(edges.test(v));
      if (edges.test(v)) near_crease.count(distance <= 2);
    }
  }
  record("on_crease", on_crease);
  record("near_crease", near_crease);
  EXPECT_GE(on_crease.share(), 0.95);
  EXPECT_GE(near_crease.share(), 0.99);
}

TEST(Corner, IsMostlyKeptInTheMap) {
  Random random(9);
  Tally tally;
  for (int i = 0; i < 60; ++i) {
    const Scene scene = cornerScene(random, 14);
    const auto edges = mapEdgesOf(scene);
    for (const VoxelIndex& v : scene.voxels) {
      if (scene.cornerDistance(v) <= 1) tally.count(edges.test(v));
    }
  }
  record("map", tally);
  EXPECT_GE(tally.share(), 0.8);
}

TEST(Dihedral, MostOf120DegreesIsFoundUnlessSupportIsHigh) {
  const CreaseTally plain = tallyDihedrals(120, kDefaults, kNoSupport);
  const CreaseTally sparse = tallyDihedrals(120, kDefaults, 0.3);
  const CreaseTally dense = tallyDihedrals(120, kDefaults, 0.5);
  record("plain", plain.on_crease);
  record("support_0.3", sparse.on_crease);
  record("support_0.5", dense.on_crease);
  EXPECT_GE(plain.on_crease.share(), 0.92);
  EXPECT_GE(sparse.on_crease.share(), 0.92);
  EXPECT_GE(dense.on_crease.share(), 0.30);
  EXPECT_LE(dense.on_crease.share(), 0.50);
}

TEST(Dihedral, FlatterThan150DegreesIsInvisible) {
  for (const double angle : {150.0, 165.0}) {
    const CreaseTally plain = tallyDihedrals(angle, kDefaults, kNoSupport);
    record("plain_" + std::to_string(angle), plain.on_crease);
    EXPECT_LE(plain.on_crease.share(), 0.03);
    EXPECT_EQ(0, tallyDihedrals(angle, kDefaults, 0.3).on_crease.edges);
  }
}

TEST(Dihedral, PaperModeFindsRightAngles) {
  const CreaseTally tally = tallyDihedrals(90, kPaper, kNoSupport);
  record("on_crease", tally.on_crease);
  record("on_faces", tally.on_faces);
  EXPECT_GE(tally.on_crease.share(), 0.99);
  EXPECT_LE(tally.on_faces.share(), 0.005);
}

TEST(Plane, HoldsNoEdges) {
  const PlaneTally plain = tallyPlanes(0.0, kDefaults, kNoSupport);
  record("plain", plain.inside);
  EXPECT_LE(plain.inside.share(), 0.0005);
  EXPECT_EQ(0, tallyPlanes(0.0, kDefaults, 0.3).inside.edges);
}

TEST(Plane, HoldsAlmostNoEdgesWithNoiseOfAThirdOfAVoxel) {
  for (const double support : {kNoSupport, 0.3, 0.5}) {
    const PlaneTally tally = tallyPlanes(0.3, kDefaults, support);
    record("support_" + std::to_string(support), tally.inside);
    EXPECT_LE(tally.inside.share(), 0.0005);
  }
}

TEST(Plane, RimsAreEdgesOnlyWithoutSupport) {
  const PlaneTally plain = tallyPlanes(0.0, kDefaults, kNoSupport);
  record("plain", plain.rim);
  EXPECT_GE(plain.rim.share(), 0.5);
  EXPECT_EQ(0, tallyPlanes(0.0, kDefaults, 0.3).rim.edges);
}

TEST(Plane, NoisyRimsNeedTheSupportOfMaps) {
  const PlaneTally sparse = tallyPlanes(0.3, kDefaults, 0.3);
  record("support_0.3", sparse.rim);
  EXPECT_GE(sparse.rim.share(), 0.5);
  EXPECT_EQ(0, tallyPlanes(0.3, kDefaults, 0.5).rim.edges);
}

TEST(Support, SeparatesEdgesFromPlanes) {
  Random random(12);
  double plane = 0.0;
  double edge = 10.0;
  for (int i = 0; i < 8; ++i) {
    const Scene flat = planeScene(random, 24);
    const ReferenceExtractor on_plane(flat.voxels);
    for (const VoxelIndex& v : flat.voxels) plane = std::max(plane, on_plane.support(v));
    const Scene bent = dihedralScene(random, 90, 24, 12);
    const ReferenceExtractor on_edge(bent.voxels);
    for (const VoxelIndex& v : bent.voxels) {
      const bool on_crease = bent.creaseDistance(v) <= 0.5 && bent.rimDistance(v) > 5;
      if (on_crease) edge = std::min(edge, on_edge.support(v));
    }
  }
  RecordProperty("plane_and_rim_at_most", std::to_string(plane));
  RecordProperty("right_angle_at_least", std::to_string(edge));
  EXPECT_LE(plane, 0.25);
  EXPECT_GE(edge, 0.40);
}

TEST(Corner, IsKeptInDefaultMode) {
  for (const double support : {kNoSupport, 0.3, 0.5}) {
    const Tally tally = tallyCorners(kDefaults, support);
    record("support_" + std::to_string(support), tally);
    EXPECT_EQ(tally.voxels, tally.edges);
  }
}

TEST(Corner, IsMostlyDroppedInPaperMode) {
  const Tally tally = tallyCorners(kPaper, kNoSupport);
  record("paper", tally);
  EXPECT_LE(tally.share(), 0.1);
}

TEST(Rod, OneVoxelThickIsAnEdgeOnlyWithoutSupport) {
  const Tally plain = tallyAll(rods(), kDefaults, kNoSupport);
  record("plain", plain);
  EXPECT_GE(plain.share(), 0.8);
  EXPECT_EQ(0, tallyAll(rods(), kDefaults, 0.3).edges);
}

TEST(Rings, ThreeVoxelsApartAreEdgesOnlyWithoutSupport) {
  const Tally plain = tallyAll(rings(), kDefaults, kNoSupport);
  record("plain", plain);
  EXPECT_GE(plain.share(), 0.9);
  EXPECT_EQ(0, tallyAll(rings(), kDefaults, 0.3).edges);
}

/// A scan of half the map's voxel size that holds the eighths of `voxels` with some probability.
VoxelScan scanOf(const Voxels& voxels, Random& random) {
  VoxelScan scan;
  scan.voxel_size = 0.05;
  for (const VoxelIndex& v : voxels) {
    const size_t before = scan.voxels.size();
    for (int child = 0; child < 8; ++child) {
      const bool last_chance = child == 7 && scan.voxels.size() == before;
      if (!last_chance && !random.chance(0.3)) continue;
      scan.voxels.emplace_back().index = {2 * v.x + (child & 1), 2 * v.y + ((child >> 1) & 1),
                                          2 * v.z + (child >> 2)};
    }
  }
  return scan;
}

void expectFlagsOfTheirMapVoxels(EdgeExtractor& extractor, const Scene& scene, Random& random) {
  const auto edges = edgesOf(scene, kDefaults, kDefaults.scan.support);
  VoxelScan scan = scanOf(scene.voxels, random);
  for (ScanVoxel& voxel : scan.voxels) voxel.edge = random.chance(0.5);  // must be overwritten
  const EdgeCount count = extractor.extract(scan);
  EXPECT_EQ(scene.voxels.size(), count.occupied);
  EXPECT_EQ(edges.voxelCount(), count.edges);
  EXPECT_GT(count.edges, 0U);
  const ReferenceExtractor reference(scene.voxels);
  const auto sparse = std::count_if(scene.voxels.begin(), scene.voxels.end(),
                                    [&](const VoxelIndex& v) { return reference.isSparse(v); });
  EXPECT_EQ(static_cast<size_t>(sparse), count.sparse);
  for (const ScanVoxel& voxel : scan.voxels) {
    ASSERT_EQ(edges.test(coarser(voxel.index, 1)), voxel.edge);
  }
}

TEST(Extractor, FlagsTheScanVoxelsInEdgeVoxelsOfTheMapsSize) {
  Random random(13);
  EdgeExtractor extractor(kDefaults, 2);
  for (int i = 0; i < 4; ++i) {
    expectFlagsOfTheirMapVoxels(extractor, cornerScene(random, 20), random);
  }
}

/// Voxels far apart, some with another one at the end of their reach or beyond, on block borders
/// too.
Voxels scatteredVoxels(Random& random) {
  Voxels voxels;
  for (int32_t i = 0; i < 60; ++i) {
    const VoxelIndex v = random.voxelIn(0, 15) + VoxelIndex{48 * (i % 8), 48 * (i / 8), 0};
    voxels.push_back(v);
    if (i % 3 == 0) voxels.push_back(v + random.voxelIn(-4, 4));
  }
  return sorted(voxels);
}

TEST(Extractor, LabelsVoxelsThatStandAloneByTheDefinition) {
  Random random(15);
  for (const EdgeMode mode : {EdgeMode::kDefault, EdgeMode::kPaper}) {
    for (const double support : {kNoSupport, 0.35}) {
      EdgeConfig config;
      config.mode = mode;
      config.magnitude = 0.001;  // so that there are edges among them
      Scene scene;
      scene.voxels = scatteredVoxels(random);
      const ReferenceExtractor reference(scene.voxels);
      const Voxels expected = mode == EdgeMode::kPaper
                                  ? reference.paperEdges()
                                  : reference.edges(config.magnitude, {config.scan.ratio, support});
      EXPECT_TRUE(sameVoxels(expected, voxelsOf(edgesOf(scene, config, support))));
      if (mode == EdgeMode::kDefault && support == kNoSupport) EXPECT_GT(expected.size(), 20U);
    }
  }
}

TEST(Extractor, AnEmptyScanHasNoEdges) {
  VoxelScan scan;
  const EdgeCount count = EdgeExtractor(kDefaults, 1).extract(scan);
  EXPECT_EQ(0U, count.occupied);
  EXPECT_EQ(0U, count.edges);
  EXPECT_EQ(0U, count.sparse);
}

}  // namespace
}  // namespace edgevox::test
