// SPDX-License-Identifier: BSD-3-Clause
// The Gaussians of a map against their formula in double precision.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "edgevox/occupied_voxel_map.hpp"
#include "support/scans.hpp"

namespace edgevox::test {
namespace {

using Eigen::Vector3d;

OccupiedVoxelMap mapOf(const std::vector<Centroids>& scans) {
  OccupiedVoxelMap map(kScanMapVoxel, 3.2, MapConfig{}, EdgeConfig{}, 1);
  for (const Centroids& scan : scans) map.insert(scan);
  map.label();
  return map;
}

struct Gaussian {
  Vector3d mean;
  Eigen::Matrix3d inverse;      ///< of the covariance
  Eigen::Matrix3d information;  ///< the same without its smallest eigenvalue
};

/// Design: C = (S + 2 (.3 r)^2 I) / (n + 2) + (2 cm)^2 I.
Gaussian gaussianOf(const Centroids& centroids, double size) {
  const auto n = static_cast<double>(centroids.size());
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  Gaussian gaussian{Vector3d::Zero(), {}, {}};
  for (const Vector3d& centroid : centroids) gaussian.mean += centroid / n;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Vector3d& centroid : centroids) {
    scatter += (centroid - gaussian.mean) * (centroid - gaussian.mean).transpose();
  }
  const Eigen::Matrix3d covariance =
      (scatter + 2 * std::pow(0.3 * size, 2) * identity) / (n + 2) + 0.02 * 0.02 * identity;
  gaussian.inverse = covariance.inverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(gaussian.inverse);
  gaussian.information = gaussian.inverse - solver.eigenvalues()[0] * identity;
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
  int compared = 0;
};

GaussianErrors errorsOf(const OccupiedVoxelMap& map, const std::vector<Centroids>& scans,
                        bool all) {
  GaussianErrors errors;
  for (int level = 1; level <= OccupiedVoxelMap::kGaussianLevels; ++level) {
    for (const auto& [v, cell] : accumulate(scans, level)) {
      const VoxelGaussian* actual = map.gaussians(level).find(v, all);
      if (actual == nullptr) continue;
      const Gaussian expected = gaussianOf(cell.centroids, map.voxelSize(level));
      const double mean = (actual->mean.cast<double>() - expected.mean).norm();
      const double information =
          (symmetric(actual->information) - expected.information).cwiseAbs().maxCoeff() /
          expected.inverse.cwiseAbs().maxCoeff();
      errors.mean = std::max(errors.mean, mean);
      errors.information = std::max(errors.information, information);
      ++errors.compared;
    }
  }
  return errors;
}

void expectSmall(const GaussianErrors& errors) {
  ::testing::Test::RecordProperty("mean_error_m", std::to_string(errors.mean * 1e6) + "e-6");
  ::testing::Test::RecordProperty("information_error",
                                  std::to_string(errors.information * 1e6) + "e-6");
  EXPECT_LT(errors.mean, 1e-6);
  EXPECT_LT(errors.information, 1e-4);
}

TEST(Gaussians, OfAllVoxelsAreThoseOfAllCentroids) {
  const auto scans = randomScans(9, 5);
  OccupiedVoxelMap map = mapOf(scans);
  map.prepareAll();
  const GaussianErrors errors = errorsOf(map, scans, true);
  EXPECT_EQ(accumulate(scans, 1).size() + accumulate(scans, 2).size(),
            static_cast<size_t>(errors.compared));
  expectSmall(errors);
}

TEST(Gaussians, OfSelectedVoxelsAreUpToDateAfterEveryScan) {
  const auto scans = randomScans(12, 6);
  MapConfig config;
  config.label_every = 2;
  OccupiedVoxelMap map(kScanMapVoxel, 3.2, config, EdgeConfig{}, 1);
  for (size_t scan = 0; scan < scans.size(); ++scan) {
    map.insert(scans[scan]);
    const auto so_far = static_cast<std::ptrdiff_t>(scan) + 1;
    const GaussianErrors errors = errorsOf(map, {scans.begin(), scans.begin() + so_far}, false);
    EXPECT_EQ(scan > 0, errors.compared > 100);
    expectSmall(errors);
  }
}

double squaredDistance(const VoxelGaussian& gaussian, const Eigen::Vector3f& point) {
  const Vector3d e = (point - gaussian.mean).cast<double>();
  return e.dot(symmetric(gaussian.information) * e);
}

void expectNearest(const GaussianLevel& level, const Eigen::Vector3f& point, bool all) {
  const VoxelIndex centre = voxelAt(point, 1.0 / level.voxelSize());
  double least = std::numeric_limits<double>::infinity();
  for (const VoxelIndex& offset : std::vector<VoxelIndex>{
           {0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
    const VoxelGaussian* candidate = level.find(centre + offset, all);
    if (candidate != nullptr) least = std::min(least, squaredDistance(*candidate, point));
  }
  float distance = 0.0F;
  const VoxelGaussian* nearest = level.nearest(point, all, distance);
  ASSERT_EQ(std::isinf(least), nearest == nullptr);
  if (nearest == nullptr) return;
  const double tolerance = 1e-4 * (1.0 + least);
  ASSERT_NEAR(least, static_cast<double>(distance), tolerance);
  ASSERT_NEAR(least, squaredDistance(*nearest, point), tolerance);
}

TEST(Gaussians, NearestIsThatOfTheSevenVoxels) {
  const auto scans = randomScans(10, 3);
  OccupiedVoxelMap map = mapOf(scans);
  map.prepareAll();
  Random random(11);
  for (int level = 1; level <= OccupiedVoxelMap::kGaussianLevels; ++level) {
    for (const Vector3d& centroid : scans[0]) {
      if (!random.chance(0.2)) continue;
      const Vector3d near = centroid + random.vectorIn(-0.3, 0.3);
      for (const bool all : {false, true}) {
        expectNearest(map.gaussians(level), near.cast<float>(), all);
      }
    }
  }
}

}  // namespace
}  // namespace edgevox::test
