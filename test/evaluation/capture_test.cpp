// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/capture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "edgevox/scan/motion.hpp"

namespace edgevox {
namespace {

CaptureProbe probe(uint64_t stream) {
  CaptureProbe made;
  made.T_map_sensor.translation() << 30.0, -4.0, 1.0;
  made.T_map_sensor.linear() = rotationOf({0.2, -0.1, 2.0});
  made.stream = stream;
  return made;
}

struct Offsets {
  std::vector<double> metres;
  std::vector<double> degrees;
  std::vector<double> along_x;
};

Offsets offsetsOf(const Disturbance& disturbance, size_t trials) {
  Offsets offsets;
  const CaptureProbe of = probe(3);
  capture(of, disturbance, trials, [&](const Pose& guess, uint64_t) -> CapturedPose {
    const Eigen::Vector3d off = guess.translation() - of.T_map_sensor.translation();
    offsets.metres.push_back(off.norm());
    offsets.along_x.push_back(off.x());
    offsets.degrees.push_back(rotationAngle(of.T_map_sensor.inverse() * guess) * 180.0 / M_PI);
    return {};
  });
  return offsets;
}

double meanSquare(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return sum / static_cast<double>(values.size());
}

size_t countBelow(const std::vector<double>& values, double limit) {
  return static_cast<size_t>(
      std::count_if(values.begin(), values.end(), [=](double value) { return value < limit; }));
}

TEST(Capture, DisturbancesAreAsTheySay) {
  constexpr size_t kTrials = 2000;
  const Offsets by = offsetsOf(disturbedBy(1.5, 30.0), kTrials);
  for (size_t i = 0; i < kTrials; ++i) {
    ASSERT_NEAR(by.metres[i], 1.5, 1e-9);
    ASSERT_NEAR(by.degrees[i], 30.0, 1e-6);
  }
  EXPECT_NEAR(static_cast<double>(countBelow(by.along_x, 0.0)), kTrials / 2.0, 100.0);

  const Offsets within = offsetsOf(disturbedWithin(2.0, 40.0), kTrials);
  EXPECT_EQ(countBelow(within.metres, 2.0), kTrials);
  EXPECT_EQ(countBelow(within.degrees, 40.0), kTrials);
  EXPECT_NEAR(static_cast<double>(countBelow(within.metres, 1.0)), kTrials / 2.0, 100.0);
  EXPECT_NEAR(static_cast<double>(countBelow(within.degrees, 20.0)), kTrials / 2.0, 100.0);

  const Offsets normal = offsetsOf(disturbedNormally(0.5, 10.0), kTrials);
  EXPECT_NEAR(meanSquare(normal.along_x), 0.25, 0.03);
  EXPECT_NEAR(meanSquare(normal.degrees), 300.0, 30.0);
}

TEST(Capture, CountsByAcceptanceAndTruth) {
  const CaptureProbe of = probe(0);
  size_t trial = 0;
  const auto counts =
      capture(of, disturbedBy(1.0, 20.0), 5, [&](const Pose& guess, uint64_t) -> CapturedPose {
        Pose near = of.T_map_sensor;
        near.translation().x() += 0.09;
        Pose turned = of.T_map_sensor;
        turned.linear() *= rotationOf({0.0, 0.0, 1.1 * M_PI / 180.0});
        const std::vector<CapturedPose> found = {
            {near, true}, {near, false}, {guess, true}, {guess, false}, {turned, true}};
        return found[trial++];
      });
  EXPECT_EQ(counts.right, 1U);
  EXPECT_EQ(counts.refused, 2U);
  EXPECT_EQ(counts.wrong, 2U);
  EXPECT_EQ(counts.trials(), 5U);
  EXPECT_EQ(counts.milliseconds.size(), 5U);
}

TEST(Capture, GuessesDependOnTheProbeAlone) {
  const auto guessesOf = [](const CaptureProbe& of) {
    std::vector<double> guesses;
    capture(of, disturbedWithin(1.0, 20.0), 4, [&](const Pose& guess, uint64_t) -> CapturedPose {
      guesses.push_back(guess.translation().x());
      return {};
    });
    return guesses;
  };
  EXPECT_EQ(guessesOf(probe(5)), guessesOf(probe(5)));
  EXPECT_NE(guessesOf(probe(5)), guessesOf(probe(6)));
}

}  // namespace
}  // namespace edgevox
