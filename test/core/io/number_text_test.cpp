// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/io/number_text.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace edgevox {
namespace {

TEST(NumberText, FixedHasSoManyDecimals) {
  EXPECT_EQ("0.50", fixedText(0.5, 2));
  EXPECT_EQ("-3", fixedText(-3.4, 0));
  EXPECT_EQ(303U, fixedText(1e300, 1).size());
}

TEST(NumberText, ShortHasNoZerosAtItsEnd) {
  EXPECT_EQ("0.5", shortText(0.5));
  EXPECT_EQ("100", shortText(100.0));
  EXPECT_EQ("0.333333", shortText(1.0 / 3.0));
  EXPECT_EQ("0.33", shortText(1.0 / 3.0, 2));
  EXPECT_EQ("1e+06", shortText(1e6));
  EXPECT_EQ("0.10000000000000001", shortText(0.1, 17));
  EXPECT_EQ("inf", shortText(std::numeric_limits<double>::infinity()));
  EXPECT_EQ("nan", shortText(std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace edgevox
