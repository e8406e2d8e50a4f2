// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/ring_buffer.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace edgevox {
namespace {

std::vector<int> inOrder(const RingBuffer<int>& buffer) {
  std::vector<int> values;
  for (size_t i = 0; i < buffer.size(); ++i) values.push_back(buffer[i]);
  return values;
}

TEST(RingBuffer, HoldsTheLastValuesInTheirOrder) {
  for (const int capacity : {1, 2, 3, 7}) {
    RingBuffer<int> buffer(static_cast<size_t>(capacity));
    EXPECT_TRUE(buffer.empty());
    std::vector<int> expected;
    for (int value = 0; value < 20; ++value) {
      buffer.push(value);
      expected.push_back(value);
      if (value >= capacity) expected.erase(expected.begin());
      ASSERT_EQ(expected, inOrder(buffer));
      EXPECT_EQ(expected.front(), buffer.oldest());
      EXPECT_EQ(expected.back(), buffer.newest());
      EXPECT_EQ(value + 1 >= capacity, buffer.isFull());
    }
  }
}

TEST(RingBuffer, BeginsAnewWhenCleared) {
  RingBuffer<int> buffer(3);
  for (const int value : {1, 2, 3, 4}) buffer.push(value);
  buffer.clear();
  EXPECT_TRUE(buffer.empty());
  for (const int value : {5, 6}) buffer.push(value);
  EXPECT_EQ((std::vector<int>{5, 6}), inOrder(buffer));
  EXPECT_EQ(2U, buffer.values().size());
}

}  // namespace
}  // namespace edgevox
