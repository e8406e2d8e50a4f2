// SPDX-License-Identifier: BSD-3-Clause
// The surfaces of a map against their formula in double precision.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "edgevox/map/map_builder.hpp"
#include "support/random.hpp"
#include "support/scans.hpp"

namespace edgevox::test {
namespace {

using Eigen::Vector3d;

MapBuilder mapOf(const std::vector<Centroids>& scans) {
  MapBuilder map(kScanMapVoxel, MapConfig{}, EdgeConfig{}, 1);
  for (const Centroids& scan : scans) map.insert(scan, farSensor());
  map.label();
  return map;
}

struct Gaussian {
  Vector3d mean = Vector3d::Zero();
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();  ///< of the covariance
  Eigen::Matrix3d information =
      Eigen::Matrix3d::Zero();       ///< all of it across the surface, a share along it
  Vector3d side = Vector3d::Zero();  ///< seen from behind where its product with a view is below -1
};

/// C = (S + 2 (.3 r)^2 I) / (n + 2) + (2 cm)^2 I with the eigenvalues s <= m <= l and n that of s:
/// W = a (C^-1 - I/l) + (1 - a) b (1/s - 1/m) n n^T. b = (m / 0.3 l)^2, at most 1; a = 10 (s /
/// trace)^2, at most 0.1. Flat (s < a tenth of the trace): seen from behind from a cosine of -0.02
/// to the normal on; else from one of -0.3 to the mean view.
Gaussian gaussianOf(const Centroids& centroids, const Centroids& views, double size) {
  const auto count = static_cast<double>(centroids.size());
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  Gaussian gaussian;
  for (const Vector3d& centroid : centroids) gaussian.mean += centroid / count;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Vector3d& centroid : centroids) {
    scatter += (centroid - gaussian.mean) * (centroid - gaussian.mean).transpose();
  }
  const Eigen::Matrix3d covariance =
      (scatter + 2 * std::pow(0.3 * size, 2) * identity) / (count + 2) + 0.02 * 0.02 * identity;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  const Vector3d& values = solver.eigenvalues();
  const Vector3d normal = solver.eigenvectors().col(0);
  gaussian.inverse = covariance.inverse();
  const bool flat = values[0] < 0.1 * values.sum();
  const double patch = std::min(1.0, std::pow(values[1] / values[2] / 0.3, 2));
  const double share = std::min(0.1, 10 * std::pow(values[0] / values.sum(), 2));
  gaussian.information =
      share * (gaussian.inverse - identity / values[2]) +
      (1 - share) * patch * (1 / values[0] - 1 / values[1]) * normal * normal.transpose();
  Vector3d view = Vector3d::Zero();
  for (const Vector3d& v : views) view += v;
  gaussian.side = flat ? Vector3d(normal * (normal.dot(view) < 0 ? -1 : 1) / 0.02)
                       : Vector3d(view.normalized() / 0.3);
  return gaussian;
}

Eigen::Matrix3d symmetric(const std::array<float, 6>& m) {
  Eigen::Matrix3d out;
  out << m[0], m[3], m[5], m[3], m[1], m[4], m[5], m[4], m[2];
  return out;
}

/// Largest differences of a map's Gaussians from those recomputed.
struct GaussianErrors {
  double mean = 0.0;         ///< [m]
  double information = 0.0;  ///< of the largest element of C^-1
  double lone = 0.0;         ///< the same where all directions are alike: ill-conditioned
  int compared = 0;

  void add(const Surface& actual, const Gaussian& expected) {
    const Eigen::Matrix3d difference = symmetric(actual.information) - expected.information;
    mean = std::max(mean, (actual.mean.cast<double>() - expected.mean).norm());
    const double largest = expected.inverse.cwiseAbs().maxCoeff();
    const bool alike = expected.information.cwiseAbs().maxCoeff() < 1e-3 * largest;
    double& worst = alike ? lone : information;
    worst = std::max(worst, difference.cwiseAbs().maxCoeff() / largest);
    ++compared;
  }
};

/// Of a map that has seen no surface from behind.
GaussianErrors errorsOf(const MapBuilder& map, const std::vector<Centroids>& scans, bool all) {
  GaussianErrors errors;
  const SurfaceLevel& surfaces = map.matchMap().surfaces();
  for (const auto& [v, cell] : accumulate(scans, 1)) {
    const uint32_t slot = surfaces.slotOf(v);
    if (!all && !map.moments().cell(slot).selected) continue;
    EXPECT_FALSE(surfaces.hasBack(slot));
    errors.add(surfaces.surface(slot), gaussianOf(cell.centroids, {}, map.voxelSize(1)));
  }
  return errors;
}

void expectSmall(const GaussianErrors& errors) {
  ::testing::Test::RecordProperty("mean_error_m", std::to_string(errors.mean * 1e6) + "e-6");
  ::testing::Test::RecordProperty("information_error",
                                  std::to_string(errors.information * 1e6) + "e-6");
  EXPECT_LT(errors.mean, 1e-6);
  EXPECT_LT(errors.information, 1e-4);
  EXPECT_LT(errors.lone, 1e-2);
}

TEST(Surfaces, OfAllVoxelsAreThoseOfAllCentroids) {
  const auto scans = randomScans(9, 5);
  MapBuilder map = mapOf(scans);
  map.prepareAll();
  const GaussianErrors errors = errorsOf(map, scans, true);
  EXPECT_EQ(accumulate(scans, 1).size(), static_cast<size_t>(errors.compared));
  expectSmall(errors);
}

TEST(Surfaces, OfSelectedVoxelsAreUpToDateAfterEveryScan) {
  const auto scans = randomScans(12, 6);
  MapConfig config;
  config.label_every = 2;
  MapBuilder map(kScanMapVoxel, config, EdgeConfig{}, 1);
  for (size_t scan = 0; scan < scans.size(); ++scan) {
    map.insert(scans[scan], farSensor());
    const auto so_far = static_cast<std::ptrdiff_t>(scan) + 1;
    const GaussianErrors errors = errorsOf(map, {scans.begin(), scans.begin() + so_far}, false);
    EXPECT_EQ(scan > 0, errors.compared > 100);
    expectSmall(errors);
  }
}

/// The two sides of a voxel, point by point, by the definition.
struct TwoSidedVoxel {
  struct Side {
    Centroids centroids;
    Centroids views;
    Gaussian gaussian;
    void update() { gaussian = gaussianOf(centroids, views, kSize); }
  };
  static constexpr double kSize = 0.4;  // [m]
  std::vector<Side> sides;

  /// Between two updates a view is compared with the first side as it was at the last.
  void add(const Vector3d& centroid, const Vector3d& to_sensor) {
    const bool behind = !sides.empty() && !sides[0].gaussian.side.isZero() &&
                        sides[0].gaussian.side.dot(to_sensor) < -1;
    if (sides.size() < (behind ? 2U : 1U)) sides.emplace_back();
    Side& side = sides[behind ? 1 : 0];
    side.centroids.push_back(centroid);
    side.views.push_back(to_sensor);
  }
};

/// Surfaces and the moments they are computed from.
struct Level {
  SurfaceLevel surfaces;
  MomentLevel moments;

  explicit Level(double voxel_size) : surfaces(voxel_size), moments(voxel_size) {}
  void add(const VoxelIndex& v, const Vector3d& point, const Eigen::Vector3f& to_sensor,
           uint32_t scan) {
    moments.add(moments.slotFor(v, surfaces), point, to_sensor, scan, surfaces);
  }
  void select(const VoxelIndex& v, bool selected) {
    moments.select(surfaces.slotOf(v), selected, surfaces);
  }
  const Surface& surface(const VoxelIndex& v) const { return surfaces.surface(surfaces.slotOf(v)); }
};

/// A room's walls, seen from anywhere inside and outside: many from both sides.
struct TwoSidedLevel {
  Level level{TwoSidedVoxel::kSize};
  std::map<VoxelIndex, TwoSidedVoxel> expected;
  std::vector<Centroids> scans = randomScans(21, 8);

  TwoSidedLevel() {
    Random random(5);
    uint32_t number = 0;
    for (const Centroids& scan : scans) addScan(scan, random.vectorIn(-5, 5), ++number);
  }

  void addScan(const Centroids& scan, const Vector3d& sensor, uint32_t number) {
    for (const Vector3d& centroid : scan) {
      const VoxelIndex v = voxelAt(centroid, 1.0 / TwoSidedVoxel::kSize);
      const Eigen::Vector3f to_sensor = (sensor - centroid).normalized().cast<float>();
      level.add(v, centroid, to_sensor, number);
      expected[v].add(centroid, to_sensor.cast<double>());
    }
    for (auto& [v, voxel] : expected) {
      level.select(v, true);  // which updates all of it
      level.select(v, false);
      for (auto& side : voxel.sides) side.update();
    }
  }
};

TEST(Sides, AreThoseOfTheDefinition) {
  const TwoSidedLevel both;
  GaussianErrors errors;
  double side_error = 0.0;
  int backs = 0;
  for (const auto& [v, voxel] : both.expected) {
    const Surface* actual = &both.level.surface(v);
    ASSERT_EQ(voxel.sides.size() == 2, actual->back_surface != Surface::kNone);
    for (const auto& side : voxel.sides) {
      errors.add(*actual, side.gaussian);
      const double error = (actual->side.cast<double>() - side.gaussian.side).norm();
      side_error = std::max(side_error, error / side.gaussian.side.norm());
      if (voxel.sides.size() == 2) {
        actual = &both.level.surfaces.surface(both.level.surface(v).back_surface);
      }
    }
    backs += voxel.sides.size() == 2 ? 1 : 0;
  }
  ::testing::Test::RecordProperty("voxels", static_cast<int>(both.expected.size()));
  ::testing::Test::RecordProperty("backs", backs);
  ::testing::Test::RecordProperty("side_error", std::to_string(side_error * 1e6) + "e-6");
  EXPECT_GT(backs, 50);
  EXPECT_GT(static_cast<int>(both.expected.size()) - backs, 50);
  EXPECT_LT(side_error, 1e-2);
  expectSmall(errors);
}

double squaredDistance(const Surface& gaussian, const Eigen::Vector3f& point) {
  const Vector3d e = (point - gaussian.mean).cast<double>();
  return e.dot(symmetric(gaussian.information) * e);
}

/// The surface of a voxel that faces the sensor, if there is one.
const Surface* facing(const Level& level, const VoxelIndex& v, const Eigen::Vector3f& to_sensor,
                      bool all) {
  const uint32_t slot = level.surfaces.slotOf(v);
  if (slot == Surface::kNone || !(all || level.moments.cell(slot).selected)) return nullptr;
  const Surface& first = level.surfaces.surface(slot);
  if (!(first.side.dot(to_sensor) < -1)) return &first;
  return level.surfaces.hasBack(slot) ? &level.surfaces.surface(first.back_surface) : nullptr;
}

/// Returns the number of candidates.
int expectNearest(const Level& level, const Eigen::Vector3f& point,
                  const Eigen::Vector3f& to_sensor, bool all) {
  const VoxelIndex centre = voxelAt(point, 1.0 / level.surfaces.voxelSize());
  double least = std::numeric_limits<double>::infinity();
  int candidates = 0;
  for (const VoxelIndex& offset : std::vector<VoxelIndex>{
           {0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
    const Surface* candidate = facing(level, centre + offset, to_sensor, all);
    if (candidate == nullptr) continue;
    least = std::min(least, squaredDistance(*candidate, point));
    ++candidates;
  }
  float distance = 0.0F;
  const SurfaceLevel& surfaces = level.surfaces;
  const Surface* nearest =
      surfaces.nearest(surfaces.around(surfaces.voxelOf(point), all), point, to_sensor, distance);
  EXPECT_EQ(std::isinf(least), nearest == nullptr);
  if (nearest == nullptr || candidates == 0) return 0;
  const double tolerance = 1e-4 * (1.0 + least);
  EXPECT_NEAR(least, static_cast<double>(distance), tolerance);
  EXPECT_NEAR(least, squaredDistance(*nearest, point), tolerance);
  return candidates;
}

TEST(Nearest, IsThatOfTheSevenVoxelsThatFaceTheSensor) {
  TwoSidedLevel both;
  Random random(11);
  for (const auto& entry : both.expected) {
    if (random.chance(0.3)) both.level.select(entry.first, true);
  }
  std::array<int, 2> candidates{};  // by all
  for (const Vector3d& centroid : both.scans[0]) {
    if (!random.chance(0.3)) continue;
    const Vector3d near = centroid + random.vectorIn(-0.3, 0.3);
    const Eigen::Vector3f to_sensor = random.normalVector().normalized().cast<float>();
    for (const bool all : {false, true}) {
      candidates[all ? 1 : 0] += expectNearest(both.level, near.cast<float>(), to_sensor, all);
    }
  }
  EXPECT_GT(candidates[0], 1000);
  EXPECT_GT(candidates[1], 2 * candidates[0]);
}

TEST(Selection, CountsVoxelsAndTheirSurfaces) {
  TwoSidedLevel both;
  size_t voxels = 0;
  size_t gaussians = 0;
  for (const auto& [v, voxel] : both.expected) {
    if (voxelHash(v) % 3 != 0) continue;
    both.level.select(v, true);
    both.level.select(v, true);
    ++voxels;
    gaussians += voxel.sides.size();
  }
  EXPECT_EQ(voxels, both.level.surfaces.selectedCount());
  EXPECT_EQ(gaussians, both.level.moments.selectedSurfaces());
  for (const auto& entry : both.expected) both.level.select(entry.first, false);
  EXPECT_EQ(0U, both.level.surfaces.selectedCount());
  EXPECT_EQ(0U, both.level.moments.selectedSurfaces());
}

/// Points of a slanted plane in the voxel (0, 0, 0) of 0.4 m.
Centroids pointsOfAPlane(Random& random, int count, double height) {
  Centroids points;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(0, 0.4);
    points.push_back({x, random.uniform(0, 0.4), height + 0.2 * x + 0.005 * random.normal()});
  }
  return points;
}

void addTo(Level& level, const Centroids& points) {
  for (const Vector3d& point : points) level.add({0, 0, 0}, point, {0, 0, 1}, 1);
}

TEST(SetMoments, GivesTheSurfaceOfThesePoints) {
  constexpr double kVoxel = 0.4;
  Random random(8);
  const Centroids kept = pointsOfAPlane(random, 60, 0.05);
  Moments moments;
  for (const Vector3d& point : kept) moments += Moments::at(point, 1);
  Level expected(kVoxel);
  addTo(expected, kept);
  Level level(kVoxel);
  addTo(level, kept);
  addTo(level, pointsOfAPlane(random, 40, 0.25));
  level.moments.setMoments(0, moments.about(voxelCentre({0, 0, 0}, kVoxel)));
  for (Level* each : {&expected, &level}) each->select({0, 0, 0}, true);
  const Surface& a = expected.surface({0, 0, 0});
  const Surface& b = level.surface({0, 0, 0});
  EXPECT_LT((a.mean - b.mean).norm(), 1e-6F);
  EXPECT_LT((a.side - b.side).norm(), 1e-2F * a.side.norm());
  for (size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(a.information[i], b.information[i], 1e-3F * a.information[2]);
  }
}

}  // namespace
}  // namespace edgevox::test
