// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/parameter.hpp"

#include <gtest/gtest.h>

namespace edgevox {
namespace {

struct Values {
  double length = 1.5;
  int count = 3;
  bool on = true;
  std::string name = "map";
};

std::vector<Parameter> listOf(Values& v) {
  return {{"group/length", &v.length, 0, 10, "m", "", "whole/reach"},
          {"count", &v.count, 1, 5, "", ""},
          {"on", &v.on, 0, 0, "", ""},
          {"name", &v.name, 0, 0, "", ""}};
}

std::string errorOf(const Parameter& parameter, const std::string& text) {
  try {
    assign(parameter, text);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(Parameter, takesTextOfItsType) {
  Values values;
  const auto list = listOf(values);
  assign(list[0], "2.25");
  assign(list[1], "5");
  assign(list[2], "false");
  assign(list[3], "odom frame");
  EXPECT_EQ(2.25, values.length);
  EXPECT_EQ(5, values.count);
  EXPECT_FALSE(values.on);
  EXPECT_EQ("odom frame", values.name);
  for (const Parameter& parameter : list) {
    const std::string text = valueText(parameter);
    assign(parameter, text);
    EXPECT_EQ(text, valueText(parameter));
  }
}

TEST(Parameter, refusesOtherTextAndStaysAsItWas) {
  Values values;
  const auto list = listOf(values);
  EXPECT_EQ("parameter 'group/length' is '11'; it must be a number from 0 to 10 m",
            errorOf(list[0], "11"));
  EXPECT_EQ("parameter 'count' is '2.5'; it must be a whole number from 1 to 5",
            errorOf(list[1], "2.5"));
  EXPECT_EQ("parameter 'on' is '1'; it must be true or false", errorOf(list[2], "1"));
  EXPECT_NE("", errorOf(list[0], "nan"));
  EXPECT_NE("", errorOf(list[0], ""));
  EXPECT_EQ(1.5, values.length);
  EXPECT_EQ(3, values.count);
  EXPECT_TRUE(values.on);
}

TEST(Parameter, rangesAreChecked) {
  Values values;
  values.count = 6;
  EXPECT_THROW(checkRange(listOf(values)[1]), ConfigError);
  values.count = 5;
  for (const Parameter& parameter : listOf(values)) EXPECT_NO_THROW(checkRange(parameter));
}

TEST(Parameter, theNearestNameIsFound) {
  Values values;
  EXPECT_EQ("group/length", nearestName(listOf(values), "lenght"));
  EXPECT_EQ("group/length", nearestName(listOf(values), "group/len"));
  EXPECT_EQ("count", nearestName(listOf(values), "counts"));
  EXPECT_EQ("group/length", nearestName(listOf(values), "whole/reach"));
}

}  // namespace
}  // namespace edgevox
