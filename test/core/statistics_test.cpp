// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace edgevox {
namespace {

TEST(Statistics, QuantilesLieBetweenTheValues) {
  EXPECT_EQ(2.5, quantile({4.0, 1.0, 3.0, 2.0}, 0.5));
  EXPECT_EQ(4.0, quantile({4.0, 1.0, 3.0, 2.0}, 1.0));
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

TEST(Statistics, TheUpperMedianIsOneOfTheValues) {
  EXPECT_EQ(3.0, upperMedian({4.0, 1.0, 3.0, 2.0}));
  EXPECT_EQ(2.0, upperMedian({3.0, 1.0, 2.0}));
  EXPECT_EQ(5.0, upperMedian({5.0}));
}

}  // namespace
}  // namespace edgevox
