// SPDX-License-Identifier: BSD-3-Clause
// What a compact map keeps, and how well.
#include "core/map/map_code.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/map/plane_code.hpp"
#include "core/map/surface_code.hpp"
#include "core/map/voxel_tree.hpp"
#include "edgevox/archive.hpp"
#include "edgevox/edges/edge_direction.hpp"
#include "edgevox/map/map_builder.hpp"
#include "edgevox/map/surface.hpp"
#include "support/scans.hpp"

namespace edgevox::test {
namespace {

std::vector<VoxelIndex> randomVoxels(uint32_t seed, size_t count, int32_t reach) {
  std::mt19937 random(seed);
  const auto next = [&] {
    return static_cast<int32_t>(random() % static_cast<uint32_t>(2 * reach)) - reach;
  };
  std::vector<VoxelIndex> voxels(count);
  for (VoxelIndex& v : voxels) v = {next(), next(), next()};
  std::sort(voxels.begin(), voxels.end(), isBeforeInTree);
  voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
  return voxels;
}

TEST(VoxelTree, OrderKeepsVoxelsOfACoarserOneTogether) {
  const auto voxels = randomVoxels(1, 3000, 40);
  for (size_t i = 1; i < voxels.size(); ++i) {
    EXPECT_TRUE(isBeforeInTree(voxels[i - 1], voxels[i]));
    EXPECT_FALSE(isBeforeInTree(voxels[i], voxels[i - 1]));
  }
  for (int level = 1; level < 7; ++level) {
    std::vector<VoxelIndex> parents;
    for (const VoxelIndex& v : voxels) {
      const VoxelIndex parent = coarser(v, level);
      if (parents.empty() || parents.back() != parent) parents.push_back(parent);
    }
    std::sort(parents.begin(), parents.end());
    EXPECT_EQ(parents.end(), std::adjacent_find(parents.begin(), parents.end())) << level;
  }
}

TEST(VoxelTree, GivesBackItsVoxels) {
  for (const int32_t reach : {3, 100, kIndexLimit}) {
    const auto voxels = randomVoxels(2, 2000, reach);
    EXPECT_EQ(voxels, VoxelTree(voxels).voxels()) << reach;
  }
  EXPECT_TRUE(VoxelTree(std::vector<VoxelIndex>()).voxels().empty());
}

TEST(VoxelTree, WhatIsNoTreeIsRefused) {
  const VoxelTree tree(randomVoxels(3, 100, 100));
  VoxelTree lacking = tree;
  lacking.children[2].bytes.pop_back();
  EXPECT_THROW(lacking.voxels(), ArchiveError);
  VoxelTree childless = tree;
  childless.children[4].bytes[0] = '\0';
  EXPECT_THROW(childless.voxels(), ArchiveError);
  VoxelTree twice = tree;
  twice.roots.push_back(twice.roots.back());
  twice.children[0].bytes.push_back('\1');
  EXPECT_THROW(twice.voxels(), ArchiveError);
  VoxelTree far = tree;
  far.roots[0].x = std::numeric_limits<int32_t>::min();
  EXPECT_THROW(far.voxels(), ArchiveError);
}

TEST(SurfaceCode, KeepsWhereASurfaceIsAndHowWellThatIsKnown) {
  constexpr double kVoxel = 0.4;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  for (int i = 0; i < 500; ++i) {
    const VoxelIndex v{i - 250, 3 * i % 100, -i};
    const Eigen::Vector3d normal =
        Eigen::Vector3d(uniform(random), uniform(random), uniform(random)).normalized();
    Moments moments;
    for (int k = 0; k < 20; ++k) {
      const Eigen::Vector3d at(uniform(random), uniform(random), uniform(random));
      const Eigen::Vector3d in_plane = at - 0.95 * at.dot(normal) * normal;
      moments += Moments::at(0.8 * kVoxel * in_plane, 1.0);
    }
    const Surface before = surfaceOf(moments, v, kVoxel, normal * (i % 2 == 0 ? 20 : -20));
    SurfaceCode code;
    code.add(before, v, kVoxel);
    const Surface after = code.surface(0, v, kVoxel);
    EXPECT_LT((before.mean - after.mean).cwiseAbs().maxCoeff(), kVoxel / 128 + 1e-4);
    const Eigen::Matrix3d a = symmetric(before.information);
    const Eigen::Matrix3d b = symmetric(after.information);
    EXPECT_LT((a - b).norm(), 0.15 * a.norm()) << i;
    EXPECT_NEAR(before.side.norm(), after.side.norm(), 1e-3 * before.side.norm());
    EXPECT_GT(before.side.normalized().dot(after.side.normalized()), std::cos(0.15));
  }
}

double degreesBetween(const Plane& a, const Plane& b) {
  return std::atan2(a.normal.cross(b.normal).norm(), a.normal.dot(b.normal)) * 180 / M_PI;
}

void expectSame(const Plane& before, const Plane& after, double size) {
  EXPECT_LT(degreesBetween(before, after), 0.15);
  EXPECT_NEAR(1.0F, after.normal.norm(), 1e-5F);
  EXPECT_NEAR(static_cast<double>(before.offset), static_cast<double>(after.offset), size / 2048);
  EXPECT_NEAR(1.0F, after.information / before.information, 0.2F);
}

TEST(PlaneCode, KeepsPlanesToATenthOfADegree) {
  constexpr double kVoxel = 3.2;
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(-1, 1);
  PlaneCode code;
  std::vector<Plane> planes;
  const Eigen::Vector3d axes[] = {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (size_t i = 0; i < 20000; ++i) {
    Eigen::Vector3d normal(uniform(random), uniform(random), uniform(random));
    if (i < 4) normal = axes[i];
    Plane plane;
    plane.normal = normal.normalized().cast<float>();
    plane.offset = static_cast<float>(0.87 * kVoxel * uniform(random));
    plane.information = static_cast<float>(std::exp2(4 + 4 * (1 + uniform(random))));
    planes.push_back(plane);
    code.add(plane, kVoxel);
  }
  for (size_t i = 0; i < planes.size(); ++i) {
    expectSame(planes[i], code.plane(i, kVoxel), kVoxel);
    if (i < 4) EXPECT_LT(degreesBetween(planes[i], code.plane(i, kVoxel)), 1e-3);
  }
  EXPECT_THROW(code.plane(planes.size(), kVoxel), ArchiveError);
}

/// An edge along `direction` where two planes meet.
BitGrid<16> creaseAlong(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d across = direction.cross(Eigen::Vector3d(0.3, 0.9, -0.2)).normalized();
  const Eigen::Vector3d other = direction.cross(across);
  BitGrid<16> grid;
  for (double along = -12; along < 12; along += 0.25) {
    for (double out = 0; out < 10; out += 0.25) {
      grid.set(voxelAt(along * direction + out * across, 1.0));
      grid.set(voxelAt(along * direction + out * other, 1.0));
    }
  }
  return grid;
}

TEST(EdgeDirection, IsThatOfTheCrease) {
  for (const Eigen::Vector3d& direction :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 1, 0),
        Eigen::Vector3d(1, -2, 3), Eigen::Vector3d(-3, 1, -1)}) {
    const Eigen::Vector3d unit = direction.normalized();
    const Eigen::Vector3f found = edgeDirections(creaseAlong(unit), {{0, 0, 0}})[0];
    EXPECT_NEAR(1.0F, found.norm(), 1e-5F);
    EXPECT_GE(found.z(), -1e-6F);
    EXPECT_GT(std::abs(found.cast<double>().dot(unit)), std::cos(0.15)) << unit.transpose();
  }
}

class Decoded : public ::testing::TestWithParam<Representation> {
 protected:
  Decoded() {
    config_.voxel_size = kScanMapVoxel;
    config_.map.coarsest_voxel = 3.2;
    config_.map.representation = GetParam();
    MapBuilder builder(config_.voxel_size, config_.map, config_.edges, 1);
    for (const Centroids& scan : randomScans(5, 8)) builder.insert(scan, {2.0, 2.0, 1.0});
    builder.label();
    before_ = builder.completeMap();
    bytes_ = encoded(before_, GetParam());
    after_ = decoded(bytes_, config_);
  }

  Config config_;
  MatchMap before_{kScanMapVoxel, 3.2};
  MatchMap after_{kScanMapVoxel, 3.2};
  std::string bytes_;
};

template <typename Grid>
std::vector<VoxelIndex> sorted(const Grid& grid) {
  std::vector<VoxelIndex> voxels;
  grid.forEach([&](const VoxelIndex& v) { voxels.push_back(v); });
  std::sort(voxels.begin(), voxels.end());
  return voxels;
}

TEST_P(Decoded, HasAllVoxels) {
  ASSERT_EQ(before_.levels(), after_.levels());
  EXPECT_EQ(sorted(before_.hitVoxels()), sorted(after_.hitVoxels()));
  EXPECT_EQ(sorted(before_.edgeVoxels()), sorted(after_.edgeVoxels()));
  for (int l = 1; l < before_.levels(); ++l) {
    EXPECT_EQ(sorted(before_.occupied(l)), sorted(after_.occupied(l))) << l;
  }
}

TEST_P(Decoded, HasTheEdgesWithinASixteenthOfAVoxel) {
  ASSERT_EQ(before_.edges().size(), after_.edges().size());
  ASSERT_GT(before_.edges().size(), 100U);
  for (size_t i = 0; i < before_.edges().size(); ++i) {
    const EdgeVoxel& a = before_.edges()[i];
    const EdgeVoxel& b = after_.edges()[i];
    EXPECT_EQ(a.voxel, b.voxel);
    EXPECT_LT((a.centroid - b.centroid).cwiseAbs().maxCoeff(), kScanMapVoxel / 32 + 1e-4);
    EXPECT_EQ(a.direction, b.direction);
  }
}

/// Mean of the centroids in a voxel of level 1 that are saved with the representation `edges`.
Eigen::Vector3f meanOf(const MatchMap& map, const VoxelIndex& v) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float count = 0;
  const auto add = [&](const auto& points) {
    for (const auto& point : points) {
      if (coarser(point.voxel, 1) != v) continue;
      sum += point.centroid;
      ++count;
    }
  };
  add(map.edges());
  add(map.besideEdges());
  return sum / count;
}

TEST_P(Decoded, HasTheSelectedSurfaces) {
  const bool of_edges = GetParam() == Representation::kEdges;
  const SurfaceLevel& a = before_.surfaces();
  const SurfaceLevel& b = after_.surfaces();
  EXPECT_GT(b.selectedCount(), 0U);
  before_.occupied(1).forEach([&](const VoxelIndex& v) {
    const bool two_sided = a.isSelected(v) && a.hasBack(a.slotOf(v));
    ASSERT_EQ(a.isSelected(v) && !(of_edges && two_sided), b.isSelected(v));
    if (!b.isSelected(v)) return;
    ASSERT_EQ(two_sided, b.hasBack(b.slotOf(v)));
    const Eigen::Vector3f mean = of_edges ? meanOf(before_, v) : a.surface(a.slotOf(v)).mean;
    EXPECT_LT((mean - b.surface(b.slotOf(v)).mean).norm(), 0.03 * before_.voxelSize(1));
  });
}

TEST_P(Decoded, HasThePlanes) {
  size_t all = 0;
  for (int l = MatchMap::kFinestPlanes; l <= MatchMap::kCoarsestPlanes; ++l) {
    const PlaneLevel& a = before_.planes(l);
    const PlaneLevel& b = after_.planes(l);
    all += a.count();
    EXPECT_EQ(a.count(), b.count()) << l;
    a.forEachVoxel([&](const VoxelIndex& v, const VoxelPlanes& planes) {
      ASSERT_NE(nullptr, b.find(v)) << l;
      ASSERT_EQ(planes.count, b.find(v)->count);
      for (uint32_t side = 0; side < planes.count; ++side) {
        expectSame(planes.sides[side], b.find(v)->sides[side], a.voxelSize());
      }
    });
  }
  RecordProperty("planes", static_cast<int>(all));
  EXPECT_EQ(GetParam() != Representation::kEdges, all > 10);
}

TEST_P(Decoded, HasThePlanesOfEachLevelApart) {
  MatchMap of_one = after_;
  std::vector<VoxelIndex> known;
  of_one.planes(3).forEachVoxel(
      [&](const VoxelIndex& v, const VoxelPlanes&) { known.push_back(v); });
  for (const VoxelIndex& v : known) of_one.planes(3).set(v, {});
  const MatchMap again = decoded(encoded(of_one, GetParam()), config_);
  EXPECT_EQ(after_.planes(2).count(), again.planes(2).count());
  EXPECT_EQ(0U, again.planes(3).count());
  EXPECT_EQ(after_.planes(4).count(), again.planes(4).count());
}

TEST_P(Decoded, IsTheSameOnceMore) {
  MatchMap again = decoded(encoded(after_, GetParam()), config_);
  EXPECT_EQ(sorted(after_.hitVoxels()), sorted(again.hitVoxels()));
  EXPECT_LT(bytes_.size(), 4 * before_.hitVoxels().voxelCount());
}

INSTANTIATE_TEST_SUITE_P(Representations, Decoded,
                         ::testing::Values(Representation::kSparse, Representation::kAll,
                                           Representation::kRandom, Representation::kEdges));

}  // namespace
}  // namespace edgevox::test
