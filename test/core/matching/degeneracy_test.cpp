// SPDX-License-Identifier: BSD-3-Clause
// Poses in a bare corridor, which leaves the way along it open.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "edgevox/map/map_builder.hpp"
#include "edgevox/mapping/mapper.hpp"
#include "edgevox/matching/matcher.hpp"
#include "support/random.hpp"
#include "support/sweeps.hpp"

namespace edgevox::test {
namespace {

using Eigen::Vector3d;

constexpr double kHalfWidth = 1.5;
constexpr double kHeight = 2.6;
constexpr double kSensorHeight = 1.2;

/// Points on the walls, the floor and the ceiling of a corridor along x; with `end`, also on a wall
/// across it at 8 m.
std::vector<Vector3d> corridor(double first, double last, bool end, Random& random) {
  constexpr int kPoints = 12000;
  constexpr double kNoise = 0.01;
  std::vector<Vector3d> points;
  for (int i = 0; i < kPoints; ++i) {
    const double x = random.uniform(first, last);
    const double y = random.uniform(-kHalfWidth, kHalfWidth);
    const double z = random.uniform(0, kHeight);
    const double side = random.chance(0.5) ? 1 : -1;
    Vector3d point(x, side * kHalfWidth, z);
    if (random.chance(0.5)) point = {x, y, side > 0 ? kHeight : 0};
    if (end && i % 10 == 0) point = {8.0, y, z};
    points.push_back(point + kNoise * random.normalVector());
  }
  return points;
}

Pose at(double x) {
  Pose pose = Pose::Identity();
  pose.translation() = Vector3d(x, 0, kSensorHeight);
  return pose;
}

struct MappedCorridor {
  Config config;
  MapBuilder builder{config.voxel_size, config.map, config.edges, 1};
  ScanSample sample;  // from x = 0

  explicit MappedCorridor(bool end) {
    Random random(5);
    for (int i = 0; i < 4; ++i) {
      builder.insert(corridor(-10, 10, end, random), at(0).translation());
    }
    builder.label();
    builder.prepareAll();
    for (const Vector3d& point : corridor(-7, 7, end, random)) {
      sample.push_back(point - at(0).translation());
    }
  }

  /// From a prediction that is `off` ahead.
  MatchResult refineFrom(double off, double sigma, bool measured) const {
    Matcher::Refinement refinement;
    refinement.start = at(off);
    refinement.start.translation().y() += 0.05;
    refinement.predicted =
        Prediction::withCovariance(refinement.start, sigma * sigma * Matrix6::Identity(), measured);
    refinement.widening = 16;
    refinement.compares = true;
    return Matcher(config.matcher).refine(builder.matchMap(), sample, refinement);
  }
};

TEST(Degeneracy, OfACorridorIsTheWayAlongIt) {
  const MappedCorridor mapped(false);
  const MatchResult result = mapped.refineFrom(0.3, 0.1, true);
  EXPECT_EQ(1, result.degeneracy.directions);
  EXPECT_GT(std::abs(result.degeneracy.weakest[0]), 0.99);
  EXPECT_NEAR(0.3, result.T_map_sensor.translation().x(), 0.005) << "the prediction is kept";
  EXPECT_NEAR(0.0, result.T_map_sensor.translation().y(), 0.01);
  EXPECT_NEAR(kSensorHeight, result.T_map_sensor.translation().z(), 0.01);
}

TEST(Degeneracy, EndsWithTheCorridor) {
  const MappedCorridor mapped(true);
  const MatchResult result = mapped.refineFrom(0.3, 0.1, true);
  EXPECT_EQ(0, result.degeneracy.directions);
  EXPECT_LT((result.T_map_sensor.translation() - at(0).translation()).norm(), 0.01);
}

TEST(Degeneracy, LeavesTheCovarianceOfThePrediction) {
  const MappedCorridor mapped(false);
  for (const bool measured : {true, false}) {
    constexpr double kSigma = 0.1;
    const MatchResult result = mapped.refineFrom(0.0, kSigma, measured);
    const Matrix6& covariance = result.covariance;
    EXPECT_NEAR(kSigma, std::sqrt(covariance(0, 0)), 0.01);
    EXPECT_LT(std::sqrt(covariance(1, 1)), 0.01);
    EXPECT_LT(std::sqrt(covariance(2, 2)), 0.01);
  }
}

TEST(Agreement, IsLeastInTheDirectionThatDoesNotFit) {
  const MappedCorridor mapped(true);
  const auto agreementAt = [&](double x) {
    Matcher::Refinement held;
    held.start = at(x);
    held.compares = true;
    held.predicted = Prediction::withCovariance(held.start, 1e-10 * Matrix6::Identity(), false);
    return Matcher(mapped.config.matcher)
        .refine(mapped.builder.matchMap(), mapped.sample, held)
        .agreement;
  };
  EXPECT_GT(agreementAt(0.0), 0.8);
  EXPECT_LT(agreementAt(0.3), 0.1) << "the wall at the end is off";
}

TEST(Agreement, IsFullWhereNothingIsKnown) {
  const MappedCorridor mapped(false);
  EXPECT_GT(mapped.refineFrom(0.3, 0.1, true).agreement, 0.8) << "any place along a corridor fits";
}

TEST(Degeneracy, LeavesAFiniteCovarianceWhereNothingIsKnown) {
  const Config config;
  const MapBuilder empty(config.voxel_size, config.map, config.edges, 1);
  const ScanSample sample(3000, Vector3d(5, 0, 0));
  const MatchResult result = Matcher(config.matcher).refine(empty.matchMap(), sample, {});
  EXPECT_EQ(6, result.degeneracy.directions);
  EXPECT_TRUE(result.covariance.isApprox(Matrix6::Identity())) << result.covariance;
}

TEST(Degeneracy, OfOneWallLeavesAFiniteCovariance) {
  const Config config;
  MapBuilder builder(config.voxel_size, config.map, config.edges, 1);
  Random random(3);
  std::vector<Vector3d> wall;
  for (int i = 0; i < 4000; ++i) {
    wall.emplace_back(5.0 + 0.01 * random.normal(), random.uniform(-4, 4), random.uniform(-1, 2));
  }
  for (int i = 0; i < 3; ++i) builder.insert(wall, {0, 0, 0});
  builder.label();
  builder.prepareAll();
  const MatchResult result = Matcher(config.matcher).refine(builder.matchMap(), wall, {});
  EXPECT_EQ(3, result.degeneracy.directions);
  EXPECT_TRUE(result.covariance.allFinite());
  EXPECT_EQ(result.covariance, result.covariance.transpose());
  EXPECT_LT(std::sqrt(result.covariance(0, 0)), 0.05);
  EXPECT_NEAR(1.0, std::sqrt(result.covariance(1, 1)), 0.1);
  EXPECT_NEAR(1.0, std::sqrt(result.covariance(2, 2)), 0.1);
}

TEST(Mapper, FollowsTheOdometryAlongACorridorAndIsLessAndLessSure) {
  const auto xOf = [](int i) { return 0.3 * i; };
  Mapper mapper{Config{}};
  Random random(9);
  double sigma = 0.0;
  for (int i = 0; i < 13; ++i) {
    Sweep sweep;
    sweep.stamp = 100.0 + 0.1 * i;
    for (const Vector3d& point : corridor(xOf(i) - 9, xOf(i) + 9, false, random)) {
      const Eigen::Vector3f p = (point - at(xOf(i)).translation()).cast<float>();
      sweep.points.push_back({p.x(), p.y(), p.z(), 0.0F});
    }
    ScanPrior prior;
    prior.T_odom_sensor = prior.T_map_first = at(xOf(i));
    const ScanResult result = mapper.process(voxelScans({sweep}, Config{})[0], prior);
    ASSERT_TRUE(result.located()) << i;
    EXPECT_LT((result.T_map_sensor.translation() - at(xOf(i)).translation()).norm(), 0.05) << i;
    if (i == 0) continue;
    EXPECT_EQ(1, result.degeneracy.directions) << i;
    const double now = std::sqrt(result.covariance(0, 0));
    EXPECT_GT(now, sigma) << i;
    EXPECT_LT(std::sqrt(result.covariance(1, 1)), 0.01) << i;
    sigma = now;
  }
  EXPECT_LT(sigma, 0.3);
}

}  // namespace
}  // namespace edgevox::test
