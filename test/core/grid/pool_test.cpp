// SPDX-License-Identifier: BSD-3-Clause
// Pools that share their chunks against vectors that share nothing.
#include <array>
#include <cstddef>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "edgevox/grid/pool.hpp"
#include "support/random.hpp"

namespace edgevox::test {
namespace {

/// As large as a tenth of a chunk, so that there are many.
struct Element {
  int value = 0;
  std::array<char, 400> filling{};
};

struct Twins {
  Pool<Element> pool;
  std::vector<int> expected;

  void grow(int value) {
    pool.grow().value = value;
    expected.push_back(value);
  }
  void edit(size_t i, int value) {
    pool.edit(i).value = value;
    expected[i] = value;
  }
  void expectEqual() const {
    ASSERT_EQ(expected.size(), pool.size());
    for (size_t i = 0; i < expected.size(); ++i) ASSERT_EQ(expected[i], pool[i].value) << i;
  }
};

Twins filled(int count) {
  Twins twins;
  for (int i = 0; i < count; ++i) twins.grow(i);
  return twins;
}

std::set<size_t> notShared(const Twins& a, const Twins& b) {
  std::set<size_t> elements;
  a.pool.forEachNotShared(b.pool, [&](size_t i) { elements.insert(i); });
  return elements;
}

TEST(Pool, CopiesOfCopiesGoTheirOwnWays) {
  Random random(1);
  std::vector<Twins> all(1);
  for (int step = 0; step < 5000; ++step) {
    const auto one = static_cast<size_t>(random.integer(0, static_cast<int32_t>(all.size()) - 1));
    if (random.chance(0.01)) {
      const Twins copy = all[one];
      all.push_back(copy);
    } else if (random.chance(0.01) && all.size() > 1) {
      all[one] = all.back();
      all.pop_back();
    } else if (all[one].expected.empty() || random.chance(0.3)) {
      all[one].grow(step);
    } else {
      const auto last = static_cast<int32_t>(all[one].expected.size()) - 1;
      all[one].edit(static_cast<size_t>(random.integer(0, last)), step);
    }
  }
  EXPECT_GT(all.size(), 10U);
  for (const Twins& twins : all) twins.expectEqual();
}

TEST(Pool, ElementsStayWhereTheyAreUntilACopyIsMade) {
  Twins twins = filled(100);
  const Element* first = &twins.pool[0];
  for (int i = 0; i < 1000; ++i) twins.grow(i);
  twins.edit(0, 5);
  EXPECT_EQ(first, &twins.pool[0]);
  const Twins copy = twins;
  EXPECT_EQ(first, &copy.pool[0]);
  EXPECT_EQ(first, &twins.pool[0]);
  twins.edit(0, 6);
  EXPECT_NE(first, &twins.pool[0]);
  EXPECT_EQ(5, copy.pool[0].value);
}

TEST(Pool, SharesAllButTheChunksThatWereWrittenTo) {
  Twins twins = filled(1000);
  const Twins copy = twins;
  EXPECT_TRUE(notShared(twins, copy).empty());
  twins.edit(500, 1);
  const auto differ = notShared(twins, copy);
  EXPECT_EQ(1U, differ.count(500));
  EXPECT_LE(differ.size(), 16U);
  EXPECT_EQ(differ, notShared(copy, twins));
  for (int i = 0; i < 100; ++i) twins.grow(i);
  EXPECT_EQ(1U, notShared(twins, copy).count(1099));
  EXPECT_EQ(1000U, filled(1000).pool.size());
  EXPECT_EQ(1000U, notShared(filled(1000), copy).size());
}

TEST(Pool, IsWholeAfterItWasMoved) {
  Twins twins = filled(1000);
  const Twins copy = twins;
  Twins moved = std::move(twins);
  moved.edit(0, 7);
  moved.grow(8);
  moved.expectEqual();
  copy.expectEqual();
}

}  // namespace
}  // namespace edgevox::test
