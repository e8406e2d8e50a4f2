// SPDX-License-Identifier: BSD-3-Clause
// Planes by voxel: what is set is found, a copy stays as it was, bytes that are damaged are told.
#include "edgevox/map/plane_level.hpp"

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "edgevox/archive.hpp"
#include "support/random.hpp"

namespace edgevox::test {
namespace {

constexpr double kSize = 0.8;  // [m]

Plane planeWith(const Eigen::Vector3d& normal, double offset) {
  Plane plane;
  plane.normal = normal.normalized().cast<float>();
  plane.offset = static_cast<float>(offset);
  plane.information = 1000.0F;
  return plane;
}

VoxelPlanes randomPlanes(Random& random) {
  VoxelPlanes planes;
  for (int i = random.integer(0, 1); i < 2; ++i) {
    planes.add(planeWith(random.normalVector(), random.uniform(-0.4, 0.4)));
  }
  planes.points = static_cast<uint32_t>(random.integer(10, 1000));
  planes.voxels = static_cast<uint32_t>(random.integer(1, 64));
  planes.forgotten = random.chance(0.5);
  return planes;
}

void expectSame(const VoxelPlanes& expected, const VoxelPlanes& actual) {
  ASSERT_EQ(expected.count, actual.count);
  EXPECT_EQ(expected.points, actual.points);
  EXPECT_EQ(expected.voxels, actual.voxels);
  EXPECT_EQ(expected.forgotten, actual.forgotten);
  for (uint32_t i = 0; i < expected.count; ++i) {
    EXPECT_EQ(expected.sides[i].normal, actual.sides[i].normal);
    EXPECT_EQ(expected.sides[i].offset, actual.sides[i].offset);
    EXPECT_EQ(expected.sides[i].information, actual.sides[i].information);
  }
}

using Expected = std::map<VoxelIndex, VoxelPlanes>;

void expectPlanes(const Expected& expected, const PlaneLevel& level) {
  ASSERT_EQ(expected.size(), level.count());
  size_t visited = 0;
  level.forEachVoxel([&](const VoxelIndex& v, const VoxelPlanes& planes) {
    ASSERT_EQ(1U, expected.count(v));
    expectSame(expected.at(v), planes);
    ++visited;
  });
  EXPECT_EQ(expected.size(), visited);
  for (const auto& [v, planes] : expected) {
    ASSERT_NE(nullptr, level.find(v));
    expectSame(planes, *level.find(v));
  }
}

/// A level and what it should hold.
struct Filled {
  PlaneLevel level{kSize};
  Expected expected;
  Random random{1};

  void change(int times) {
    for (int i = 0; i < times; ++i) {
      const VoxelIndex v = random.voxelIn(-20, 20);
      if (random.chance(0.3) && !expected.empty()) {
        const VoxelIndex gone =
            std::next(expected.begin(), random.integer(0, 5) % static_cast<int>(expected.size()))
                ->first;
        level.set(gone, {});
        expected.erase(gone);
      } else {
        level.set(v, expected[v] = randomPlanes(random));
      }
    }
  }
};

TEST(PlaneLevel, HoldsWhatWasSetLast) {
  Filled filled;
  EXPECT_EQ(nullptr, filled.level.find({0, 0, 0}));
  filled.level.set({0, 0, 0}, {});  // there were none
  EXPECT_EQ(0U, filled.level.count());
  for (int i = 0; i < 10; ++i) {
    filled.change(500);
    expectPlanes(filled.expected, filled.level);
  }
  EXPECT_LT(1000U, filled.expected.size());
  for (const auto& entry : filled.expected) filled.level.set(entry.first, {});
  expectPlanes({}, filled.level);
}

TEST(PlaneLevel, ComingAndGoingTakesNoMemory) {
  PlaneLevel level(kSize);
  Random random(2);
  const auto fill = [&](bool full) {
    for (int i = 0; i < 3000; ++i) {
      level.set({i % 15, i / 15 % 15, i / 225}, full ? randomPlanes(random) : VoxelPlanes());
    }
  };
  const auto again = [&] {
    fill(false);
    fill(true);
  };
  fill(true);
  again();
  const size_t bytes = level.bytes();
  for (int i = 0; i < 5; ++i) again();
  EXPECT_EQ(3000U, level.count());
  EXPECT_EQ(bytes, level.bytes());
  fill(false);
  EXPECT_LT(level.bytes() - level.freeBytes(), bytes / 8);
}

TEST(PlaneLevel, FindsTheSideThatIsSeen) {
  PlaneLevel level(kSize);
  const Eigen::Vector3d normal = Eigen::Vector3d(1, 2, -3).normalized();
  VoxelPlanes both;
  both.add(planeWith(normal, 0.1));
  both.add(planeWith(-normal, 0.1));
  VoxelPlanes one;
  one.add(both.sides[1]);
  const VoxelIndex two_sided{1, -2, 3};
  const VoxelIndex one_sided{1, -2, 4};
  level.set(two_sided, both);
  level.set(one_sided, one);
  const Eigen::Vector3f front = normal.cast<float>();
  EXPECT_EQ(&level.find(two_sided)->sides[0], level.find(two_sided, front));
  EXPECT_EQ(&level.find(two_sided)->sides[1], level.find(two_sided, -front));
  EXPECT_EQ(&level.find(one_sided)->sides[0], level.find(one_sided, -front));
  EXPECT_EQ(nullptr, level.find(one_sided, front));
  EXPECT_EQ(nullptr, level.find({0, 0, 0}, front));
}

TEST(Plane, FacesAwayFromWhatIsBehindIt) {
  const Plane plane = planeWith(Eigen::Vector3d::UnitZ(), 0.0);
  const auto facesAway = [&](double degrees) {
    const double angle = degrees * M_PI / 180;
    return plane.facesAway(Eigen::Vector3d(std::sin(angle), 0, std::cos(angle)).cast<float>());
  };
  EXPECT_FALSE(facesAway(0));
  EXPECT_FALSE(facesAway(91));  // noise of the normal
  EXPECT_TRUE(facesAway(92));
  EXPECT_TRUE(facesAway(180));
}

TEST(PlaneLevel, ACopyStaysAsItWas) {
  Filled filled;
  filled.change(3000);
  const PlaneLevel copy = filled.level;
  const Expected then = filled.expected;
  filled.change(3000);
  expectPlanes(then, copy);
  expectPlanes(filled.expected, filled.level);
}

std::string bytesOf(const PlaneLevel& level) {
  ArchiveWriter bytes;
  bytes(level);
  return bytes.take();
}

PlaneLevel readFrom(const std::string& bytes) {
  PlaneLevel level(kSize);
  ArchiveReader reader(bytes);
  reader(level);
  reader.requireEnd();
  return level;
}

TEST(PlaneLevel, IsTheSameWhenReadAgain) {
  Filled filled;
  filled.change(3000);
  filled.level = readFrom(bytesOf(filled.level));
  expectPlanes(filled.expected, filled.level);
  filled.change(3000);  // and goes on
  expectPlanes(filled.expected, filled.level);
}

TEST(PlaneLevel, CutBytesAreRefused) {
  Filled filled;
  filled.change(100);
  const std::string bytes = bytesOf(filled.level);
  for (size_t size = 0; size < bytes.size(); size += 1 + size / 50) {
    EXPECT_THROW(readFrom(bytes.substr(0, size)), ArchiveError) << size;
  }
}

/// Damage is refused, or has changed numbers alone.
TEST(PlaneLevel, DamageIsRefusedOrHarmless) {
  Filled filled;
  filled.change(300);
  const std::string bytes = bytesOf(filled.level);
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string damaged = bytes;
    const auto at =
        static_cast<size_t>(filled.random.uniform(0, static_cast<double>(bytes.size())));
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << filled.random.integer(0, 7)));
    try {
      const PlaneLevel level = readFrom(damaged);
      size_t count = 0;
      level.forEachVoxel([&](const VoxelIndex&, const VoxelPlanes& planes) {
        ASSERT_GE(2, planes.end() - planes.begin());
        ASSERT_LT(0, planes.end() - planes.begin());
        ++count;
      });
      ASSERT_EQ(level.count(), count);
    } catch (const ArchiveError&) {
      ++refused;
    }
  }
  RecordProperty("refused", refused);
  EXPECT_LT(100, refused);
}

}  // namespace
}  // namespace edgevox::test
