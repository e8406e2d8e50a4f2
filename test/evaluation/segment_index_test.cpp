// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/segment_index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace edgevox {
namespace {

TEST(Segment, DistanceEndsAtItsEnds) {
  const Segment segment{{0, 0, 0}, {4, 0, 0}};
  EXPECT_DOUBLE_EQ(segment.distanceTo({1, 3, 0}), 3.0);
  EXPECT_DOUBLE_EQ(segment.distanceTo({-3, 4, 0}), 5.0);
  EXPECT_DOUBLE_EQ(segment.distanceTo({7, 0, 4}), 5.0);
  EXPECT_DOUBLE_EQ((Segment{{1, 0, 0}, {1, 0, 0}}.distanceTo({1, 2, 0})), 2.0);
}

TEST(SegmentIndex, FindsWhatLookingAtAllFinds) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-3.0, 3.0);
  const auto draw = [&] {
    const double x = coordinate(random);
    const double y = coordinate(random);
    return Eigen::Vector3d(x, y, coordinate(random));
  };
  std::vector<Segment> segments;
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3d start = draw();
    segments.push_back({start, start + (i % 4) * 0.3 * draw()});
  }
  constexpr double kReach = 0.4;
  const SegmentIndex index(segments, kReach);
  size_t near = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d point = draw();
    std::vector<uint32_t> expected;
    double nearest = std::numeric_limits<double>::infinity();
    for (uint32_t s = 0; s < segments.size(); ++s) {
      const double distance = segments[s].distanceTo(point);
      if (distance > kReach) continue;
      expected.push_back(s);
      nearest = std::min(nearest, distance);
    }
    std::vector<uint32_t> found;
    index.forEachNear(point, [&](uint32_t s) { found.push_back(s); });
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
    EXPECT_EQ(index.distanceTo(point), nearest);
    near += expected.size();
  }
  EXPECT_GT(near, 200U);
}

}  // namespace
}  // namespace edgevox
