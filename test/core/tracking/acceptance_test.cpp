// SPDX-License-Identifier: BSD-3-Clause
// What a match must reach, by how sure its prediction is.
#include <gtest/gtest.h>

#include "edgevox/tracking/acceptance.hpp"

namespace edgevox::test {
namespace {

constexpr double kSure = 0.05;  // standard deviation of the step [m]
constexpr double kUnsure = 0.3;
constexpr double kVeryUnsure = 0.6;
constexpr double kUsual = 0.9;  // hit ratio

MatchRequest limitsAfter(int scans, uint64_t lost, bool blind, double step_sigma) {
  Acceptance acceptance{MatcherConfig{}, MapperConfig{}};
  for (int i = 0; i < scans; ++i) {
    acceptance.addHitRatio(kUsual);
    acceptance.addBlocked(0.0);
  }
  MatchRequest request;
  request.guess.step_sigma = step_sigma;
  acceptance.setLimits(lost, blind, request);
  return request;
}

TEST(Acceptance, IsAskedMoreOfAnUnsurePrediction) {
  const MatcherConfig config;
  const MatchRequest sure = limitsAfter(20, 0, false, kSure);
  EXPECT_FALSE(sure.doubtful);
  EXPECT_DOUBLE_EQ(config.relative_hit_ratio * kUsual, sure.required_hit_ratio);

  const MatchRequest unsure = limitsAfter(20, 0, false, kUnsure);
  EXPECT_TRUE(unsure.doubtful);
  EXPECT_DOUBLE_EQ(0.75 * kUsual, unsure.required_hit_ratio);

  const MatchRequest very = limitsAfter(20, 0, false, kVeryUnsure);
  EXPECT_TRUE(very.doubtful);
  EXPECT_DOUBLE_EQ(0.8 * kUsual, very.required_hit_ratio);
}

TEST(Acceptance, OfABlindScanRisesWithEachLostOne) {
  double before = 0.9 * kUsual;
  for (const uint64_t lost : {2U, 5U, 9U, 10U}) {
    const MatchRequest blind = limitsAfter(4, lost, true, kVeryUnsure);
    EXPECT_GT(blind.required_hit_ratio, before) << lost;
    EXPECT_EQ(blind.required_hit_ratio, blind.far_hit_ratio) << "near it is no evidence";
    before = blind.required_hit_ratio;
  }
  EXPECT_DOUBLE_EQ(kUsual, limitsAfter(4, 50, true, kVeryUnsure).required_hit_ratio);
}

TEST(Acceptance, ThreeScansDoNotShowWhatIsUsual) {
  const MatchRequest young = limitsAfter(3, 2, true, kVeryUnsure);
  EXPECT_DOUBLE_EQ(0.8 * kUsual, young.required_hit_ratio);
  EXPECT_FALSE(limitsAfter(0, 0, true, kVeryUnsure).doubtful) << "of the second scan";
}

}  // namespace
}  // namespace edgevox::test
