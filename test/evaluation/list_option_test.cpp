// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/list_option.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tools/options.hpp"

namespace edgevox {
namespace {

using Numbers = std::vector<size_t>;
using Words = std::vector<std::string>;

TEST(ListOption, NumbersAreListsAndRanges) {
  EXPECT_EQ(numbersOf("7", "seeds", 0), (Numbers{7}));
  EXPECT_EQ(numbersOf("1,3,5,8", "strides", 1), (Numbers{1, 3, 5, 8}));
  EXPECT_EQ(numbersOf("1-4", "seeds", 0), (Numbers{1, 2, 3, 4}));
  EXPECT_EQ(numbersOf("9,2-4,3,0", "seeds", 0), (Numbers{9, 2, 3, 4, 0}));
}

TEST(ListOption, RefusesWhatIsNoListOfNumbers) {
  for (const char* list :
       {"", "x", "1,", "1,,2", "-3", "3-", "1-2-3", "4-2", "0", "1.5", "123456"}) {
    EXPECT_THROW(numbersOf(list, "strides", 1), UsageError) << list;
  }
}

TEST(ListOption, NamesTheOption) {
  try {
    numbersOf("1,two", "seeds", 0);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string::npos, std::string(error.what()).find("--seeds")) << error.what();
    EXPECT_NE(std::string::npos, std::string(error.what()).find("'two'")) << error.what();
  }
}

TEST(ListOption, WordsAreEachOnce) {
  EXPECT_EQ(wordsOf("street,corridor,street", "worlds"), (Words{"street", "corridor"}));
  EXPECT_THROW(wordsOf("street,,corridor", "worlds"), UsageError);
}

}  // namespace
}  // namespace edgevox
