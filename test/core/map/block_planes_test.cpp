// SPDX-License-Identifier: BSD-3-Clause
// Planes of a block: where there are some, of which voxels, and where there must be none.
#include "core/map/block_planes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include "support/random.hpp"

namespace edgevox::test {
namespace {

using Eigen::Vector3d;

constexpr double kSize = 0.4;          // of voxels of level 1 [m]
constexpr double kBlock = 8 * kSize;   // [m]
constexpr double kSensorSigma = 0.02;  // [m]
constexpr int kFinest = BlockPlanes::kFinest;
constexpr int kCoarsest = BlockPlanes::kCoarsest;
const VoxelIndex kAt{-3, 2, 5};
const Vector3d kCorner = kBlock * Vector3d(-3, 2, 5);
const Vector3d kUp = Vector3d::UnitZ();

double degrees(double cosine) { return std::acos(std::min(std::abs(cosine), 1.0)) * 180 / M_PI; }

/// Points of a block, from its corner [m], gathered by voxel and side as a map does.
class Seen {
 public:
  /// Points that noise has moved out of the block are left out.
  void add(const Vector3d& point, const Vector3d& to_sensor, int side = 0) {
    if ((point.array() < 0).any() || (point.array() >= kBlock).any()) return;
    points_.push_back(point);
    const VoxelIndex v = voxelAt(point + kCorner, 1.0 / kSize);
    VoxelSide& seen = sides_.try_emplace({v, side}, VoxelSide{v, {}, {0, 0, 0}}).first->second;
    seen.moments += Moments::at(point - Vector3d::Constant(kBlock / 2), 1.0);
    seen.view += to_sensor;
  }

  std::vector<VoxelSide> sides() const {
    std::vector<VoxelSide> all;
    for (const auto& entry : sides_) all.push_back(entry.second);
    return all;
  }
  BlockPlanes planes(const MatchMap& before = MatchMap(kSize / 2, 2 * kBlock)) const {
    return {kAt, sides(), kSize, before};
  }
  const std::vector<Vector3d>& points() const { return points_; }

 private:
  std::map<std::pair<VoxelIndex, int>, VoxelSide> sides_;
  std::vector<Vector3d> points_;
};

/// A plane, from the corner of the block.
struct Found {
  VoxelIndex voxel;
  Vector3d normal;
  Vector3d point;  // the one nearest to the voxel's centre
  double information;

  double off(const Vector3d& at) const { return normal.dot(at - point); }
};

std::vector<Found> planesOf(const BlockPlanes& planes, int level) {
  std::vector<Found> found;
  planes.forEachVoxel([&](int l, const VoxelIndex& v, const VoxelPlanes& of_voxel) {
    if (l != level) return;
    const Vector3d centre = voxelCentre(v, kSize * (1 << (l - 1))) - kCorner;
    for (const Plane& plane : of_voxel) {
      const Vector3d normal = plane.normal.cast<double>();
      found.push_back({v, normal, centre + static_cast<double>(plane.offset) * normal,
                       static_cast<double>(plane.information)});
    }
  });
  return found;
}

std::vector<Found> allPlanesOf(const BlockPlanes& planes) {
  std::vector<Found> all;
  for (int level = kFinest; level <= kCoarsest; ++level) {
    for (const Found& found : planesOf(planes, level)) all.push_back(found);
  }
  return all;
}

/// A floor at a height, in a part of the block [m].
struct Floor {
  double height = 1.0;
  double sigma = 0.01;
  Eigen::Vector2d from{0, 0};
  Eigen::Vector2d to{kBlock, kBlock};
};

void add(const Floor& floor, int count, Random& random, Seen& seen) {
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(floor.from.x(), floor.to.x());
    const double y = random.uniform(floor.from.y(), floor.to.y());
    seen.add({x, y, floor.height + floor.sigma * random.normal()}, kUp);
  }
}

/// Of a line along x, as a ring of a lidar draws it.
void addLine(double y, double z, int count, Random& random, Seen& seen) {
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(0, kBlock);
    const double noise_y = 0.01 * random.normal();
    seen.add({x, y + noise_y, z + 0.01 * random.normal()}, Vector3d(0, 1, 1).normalized());
  }
}

Vector3d meanOf(const std::vector<Vector3d>& points) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axesOf(const std::vector<Vector3d>& points) {
  const Vector3d mean = meanOf(points);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : points) scatter += (p - mean) * (p - mean).transpose();
  const Eigen::Matrix3d covariance = scatter / static_cast<double>(points.size());
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance);
}

TEST(BlockPlanes, AWallIsOneOfTheCoarsestAndNoFinerOne) {
  Random random(1);
  Seen seen;
  const Vector3d normal = Vector3d(-0.96, 0.2, 0.17).normalized();
  const Vector3d through(1.7, 1.5, 1.6);
  for (int i = 0; i < 5000; ++i) {
    const Vector3d at = random.vectorIn(-0.8, kBlock + 0.8);
    const double off = normal.dot(at - through) - 0.01 * random.normal();
    seen.add(at - off * normal, normal);
  }
  const BlockPlanes planes = seen.planes();
  for (int level = kFinest; level < kCoarsest; ++level) {
    EXPECT_TRUE(planesOf(planes, level).empty()) << level;
  }
  const std::vector<Found> found = planesOf(planes, kCoarsest);
  ASSERT_EQ(1U, found.size());
  EXPECT_EQ(kAt, found[0].voxel);
  EXPECT_GT(found[0].normal.dot(normal), std::cos(0.1 * M_PI / 180));
  EXPECT_NEAR(0.0, found[0].off(through), 0.001);
  EXPECT_NEAR(2000.0, found[0].information, 100.0);
}

TEST(BlockPlanes, AreThoseOfThePrincipalAxes) {
  int compared = 0;
  for (uint32_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    Seen seen;
    const Vector3d normal = random.normalVector().normalized();
    const Vector3d through = random.vectorIn(1, 2);
    const double sigma = random.uniform(0, 0.05);
    for (int i = 0; i < 400; ++i) {
      const Vector3d at = random.vectorIn(0, kBlock);
      seen.add(at - (normal.dot(at - through) - sigma * random.normal()) * normal, normal);
    }
    const std::vector<Found> found = planesOf(seen.planes(), kCoarsest);
    ASSERT_GE(1U, found.size());
    if (found.empty()) continue;
    const auto solver = axesOf(seen.points());
    const double across = solver.eigenvalues()[0] + kSensorSigma * kSensorSigma;
    EXPECT_LT(degrees(found[0].normal.dot(solver.eigenvectors().col(0))), 0.05);
    EXPECT_NEAR(0.0, found[0].off(meanOf(seen.points())), 1e-5);
    EXPECT_NEAR(1.0, found[0].information * across, 1e-3);
    EXPECT_GT(found[0].normal.dot(normal), 0.0);
    ++compared;
  }
  EXPECT_GT(compared, 80);
}

TEST(BlockPlanes, AWallSeenFromBothSidesIsTwo) {
  for (const double front : {1.31, 1.5}) {  // both sides in the same voxels of level 1, and not
    Random random(2);
    Seen seen;
    const double back = front + 0.2;
    for (int i = 0; i < 6000; ++i) {
      const int side = i % 2;
      const double x = (side == 0 ? front : back) + 0.01 * random.normal();
      const double y = random.uniform(0, kBlock);
      const Vector3d to_sensor(side == 0 ? -1 : 1, 0, 0);
      seen.add({x, y, random.uniform(0, kBlock)}, to_sensor, side);
    }
    const BlockPlanes planes = seen.planes();
    EXPECT_EQ(2U, allPlanesOf(planes).size());
    const std::vector<Found> found = planesOf(planes, kCoarsest);
    ASSERT_EQ(2U, found.size());
    EXPECT_GT(-found[0].normal.dot(found[1].normal), std::cos(0.2 * M_PI / 180));
    for (const Found& plane : found) {
      const double x = plane.normal.x() < 0 ? front : back;
      EXPECT_NEAR(0.0, plane.off({x, 1.6, 1.6}), 0.002);
    }
  }
}

TEST(BlockPlanes, NoneLiesAcrossACorner) {
  size_t found = 0;
  for (uint32_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    Seen seen;
    const double height = random.uniform(0.5, kBlock - 0.5);
    const double wall = random.uniform(0.5, kBlock - 0.5);
    for (int i = 0; i < 3000; ++i) {
      const double x = random.uniform(0, kBlock);
      const double noise = 0.01 * random.normal();
      seen.add({x, random.uniform(wall, kBlock), height + noise}, kUp);
      seen.add({x, wall + noise, random.uniform(height, kBlock)}, Vector3d::UnitY());
    }
    EXPECT_TRUE(planesOf(seen.planes(), kCoarsest).empty()) << seed;
    for (const Found& plane : allPlanesOf(seen.planes())) {
      const double tilt = std::min(degrees(plane.normal.z()), degrees(plane.normal.y()));
      EXPECT_LT(tilt, 6.0) << seed << ", " << plane.normal.transpose();
      ++found;
    }
  }
  EXPECT_LT(1000U, found);
}

/// Middle to largest variance of the points in a voxel of a level.
double widthOf(const std::vector<Vector3d>& points, int level, const VoxelIndex& v) {
  std::vector<Vector3d> inside;
  for (const Vector3d& p : points) {
    if (voxelAt(p + kCorner, 1.0 / (kSize * (1 << (level - 1)))) == v) inside.push_back(p);
  }
  const Vector3d variances = axesOf(inside).eigenvalues();
  return variances[1] / variances[2];
}

/// Lines that share voxels of level 1 are not told from a patch, nor those whose axes are any as
/// they are as far apart as they are long.
TEST(BlockPlanes, TwoLinesOnFloorAndWallHaveNone) {
  int unlucky = 0;
  for (uint32_t seed = 0; seed < 400; ++seed) {
    Random random(seed);
    Seen seen;
    addLine(random.uniform(kSize, kBlock - 0.1), 0.1, random.integer(200, 400), random, seen);
    addLine(0.1, random.uniform(kSize, kBlock - 0.1), random.integer(200, 400), random, seen);
    for (int level = kFinest; level <= kCoarsest; ++level) {
      for (const Found& plane : planesOf(seen.planes(), level)) {
        EXPECT_LT(0.5, widthOf(seen.points(), level, plane.voxel)) << seed << ", level " << level;
        ++unlucky;
      }
    }
  }
  EXPECT_GT(80, unlucky);
}

TEST(BlockPlanes, ThreeLinesOnAFloorHaveOne) {
  for (uint32_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    Seen seen;
    const double gap = random.uniform(0.6, 1.2);
    const double first = random.uniform(0.2, kBlock - 0.2 - 2 * gap);
    for (int i = 0; i < 3; ++i) addLine(first + i * gap, 1.0, 200, random, seen);
    const std::vector<Found> found = planesOf(seen.planes(), kCoarsest);
    ASSERT_EQ(1U, found.size()) << seed;
    EXPECT_LT(degrees(found[0].normal.z()), 0.3);
  }
}

TEST(BlockPlanes, AreAsThickAsTheirVoxelsAllow) {
  for (const bool too_thick : {false, true}) {
    Random random(3);
    Seen seen;
    Floor floor;
    floor.sigma = (too_thick ? 1.1 : 0.9) * (0.03 + 0.015 * kBlock);
    add(floor, 5000, random, seen);
    EXPECT_EQ(too_thick ? 0U : 1U, planesOf(seen.planes(), kCoarsest).size());
  }
}

TEST(BlockPlanes, FewPointsHaveNone) {
  for (const int count : {9, 10}) {
    Random random(4);
    Seen seen;
    add({}, count, random, seen);
    EXPECT_EQ(count == 9 ? 0U : 1U, planesOf(seen.planes(), kCoarsest).size());
  }
}

/// A floor with a part in one voxel of level 2.
BlockPlanes floorWithAPart(double sigma, double sigma_of_part) {
  Random random(5);
  Seen seen;
  const Eigen::Vector2d from(0.8, 1.6);
  const Eigen::Vector2d to(1.6, 2.4);
  Seen all;
  add({1.2, sigma}, 16000, random, all);
  for (const Vector3d& p : all.points()) {
    const bool in_part = p.x() >= from.x() && p.x() < to.x() && p.y() >= from.y() && p.y() < to.y();
    if (!in_part) seen.add(p, kUp);
  }
  add({1.2, sigma_of_part, from, to}, 1000, random, seen);
  return seen.planes();
}

TEST(BlockPlanes, AFinerOneStaysWhereItIsMoreThanTwiceAsPrecise) {
  const BlockPlanes precise = floorWithAPart(0.025, 0.001);
  const std::vector<Found> found = planesOf(precise, kFinest);
  ASSERT_EQ(1U, found.size());
  EXPECT_EQ((VoxelIndex{4 * kAt.x + 1, 4 * kAt.y + 2, 4 * kAt.z + 1}), found[0].voxel);
  EXPECT_EQ(1U, planesOf(precise, kCoarsest).size());
  EXPECT_EQ(2U, allPlanesOf(precise).size());
  EXPECT_GT(found[0].information, 2 * planesOf(precise, kCoarsest)[0].information);

  EXPECT_EQ(1U, allPlanesOf(floorWithAPart(0.025, 0.01)).size());
}

/// What a plane of level 3 stands for must not get lost in one of level 4 that is as flat as that
/// of level 3, but not as those that it has replaced.
TEST(BlockPlanes, WhatReplacesAReplacedOneIsAsPreciseAsThat) {
  Random random(6);
  Seen seen;
  add({1.2, 0.010, {0.0, 0.0}, {0.8, 0.8}}, 1000, random, seen);
  for (const auto& [x, y] : {std::pair(0.8, 0.0), std::pair(0.0, 0.8), std::pair(0.8, 0.8)}) {
    add({1.2, 0.0233, {x, y}, {x + 0.8, y + 0.8}}, 1000, random, seen);
  }
  for (const auto& [x, y] : {std::pair(1.6, 0.0), std::pair(0.0, 1.6), std::pair(1.6, 1.6)}) {
    add({1.2, 0.0315, {x, y}, {x + 1.6, y + 1.6}}, 4000, random, seen);
  }
  const BlockPlanes planes = seen.planes();
  ASSERT_EQ(1U, planesOf(planes, 4).size());
  ASSERT_EQ(1U, planesOf(planes, 3).size());
  EXPECT_EQ(0U, planesOf(planes, 2).size());
  EXPECT_LT(planesOf(planes, 3)[0].information, 2 * planesOf(planes, 4)[0].information);
}

MatchMap mapOf(const BlockPlanes& planes) {
  MatchMap map(kSize / 2, 2 * kBlock);
  planes.forEachVoxel([&](int level, const VoxelIndex& v, const VoxelPlanes& of_voxel) {
    map.planes(level).set(v, of_voxel);
  });
  return map;
}

/// The height of the coarsest plane when `count` points of a floor at 1.1 m are all that is left of
/// 4000 and what came since.
double heightAfter(int count, const Eigen::Vector2d& to, const MatchMap& before) {
  Random random(8);
  Seen seen;
  add({1.1, 0.01, {0, 0}, to}, count, random, seen);
  const std::vector<Found> found = planesOf(seen.planes(before), kCoarsest);
  return found.size() == 1 ? found[0].point.z() : 0.0;
}

TEST(BlockPlanes, OfForgottenPointsStayUntilOthersLieAsWide) {
  Random random(9);
  Seen seen;
  add({}, 4000, random, seen);
  const MatchMap before = mapOf(seen.planes());
  const Eigen::Vector2d all(kBlock, kBlock);
  const Eigen::Vector2d corner(1.0, 1.0);
  EXPECT_NEAR(1.0, heightAfter(0, all, before), 0.001);
  EXPECT_NEAR(1.0, heightAfter(1900, all, before), 0.001);
  EXPECT_NEAR(1.1, heightAfter(2100, all, before), 0.001);
  EXPECT_NEAR(1.0, heightAfter(3900, corner, before), 0.001);
  EXPECT_NEAR(1.1, heightAfter(4100, corner, before), 0.002) << "nothing was forgotten";

  Seen few;
  add({1.1, 0.01, {0, 0}, corner}, 100, random, few);
  const MatchMap thawed = mapOf(few.planes(before));
  EXPECT_NEAR(1.0, heightAfter(100000, corner, thawed), 0.001);
  EXPECT_NEAR(1.1, heightAfter(2100, all, thawed), 0.001);
}

VoxelSide sideAt(const Vector3d& point, const Vector3d& to_sensor) {
  Seen seen;
  seen.add(point, to_sensor);
  return seen.sides()[0];
}

TEST(BlockPlanes, ExplainWhatLiesInThemAndWasSeenFromTheirSide) {
  Random random(7);
  Seen seen;
  add({}, 5000, random, seen);
  const BlockPlanes planes = seen.planes();
  const double three_sigma = 3 / std::sqrt(planesOf(planes, kCoarsest).at(0).information);
  EXPECT_NEAR(3 * std::hypot(0.01, kSensorSigma), three_sigma, 0.002);
  for (const double sign : {1.0, -1.0}) {
    for (const double at : {0.1, 1.6, 3.1}) {
      const Vector3d near(at, 1.0, 1.0 + sign * 0.9 * three_sigma);
      const Vector3d far(at, 1.0, 1.0 + sign * 1.1 * three_sigma);
      EXPECT_TRUE(planes.explains(sideAt(near, kUp)));
      EXPECT_FALSE(planes.explains(sideAt(near, -kUp)));
      EXPECT_FALSE(planes.explains(sideAt(far, kUp)));
    }
  }
  EXPECT_FALSE(Seen().planes().explains(sideAt({1, 1, 1}, kUp)));
}

}  // namespace
}  // namespace edgevox::test
