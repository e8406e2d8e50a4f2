// SPDX-License-Identifier: BSD-3-Clause
// Two maps in one: what it holds, as a file, and to localize in.
#include "edgevox/map/map_union.hpp"

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/map/map_code.hpp"
#include "edgevox/io/map_file.hpp"
#include "edgevox/mapping/localizer.hpp"
#include "edgevox/statistics.hpp"
#include "support/two_maps.hpp"
#include "support/voxel_sets.hpp"

namespace edgevox::test {
namespace {

template <int kSide>
Voxels inEither(const BitGrid<kSide>& a, const BitGrid<kSide>& b) {
  Voxels voxels = voxelsOf(a);
  const Voxels more = voxelsOf(b);
  voxels.insert(voxels.end(), more.begin(), more.end());
  return sorted(voxels);
}

bool sameSurface(const Surface& a, const Surface& b) {
  return a.mean == b.mean && a.information == b.information && a.side == b.side;
}

class Joined : public ::testing::TestWithParam<Representation> {
 protected:
  Joined() { config_.map.representation = GetParam(); }

  const TwoMaps& maps() {
    static std::map<Representation, TwoMaps> made;
    return made.try_emplace(GetParam(), config_).first->second;
  }
  MatchMap a() { return maps().a.map().completeMap(); }
  MatchMap b() { return maps().b.map().completeMap(); }
  MatchMap joined() { return unionOf(a(), b(), GetParam()); }
  MatchMap readAgain(const MatchMap& map) {
    return MapFile(mapFileBytes(map, config_, "map", 1), "test").matchMap();
  }

  Config config_;
};

TEST_P(Joined, HasTheVoxelsAndEdgesOfBoth) {
  const MatchMap in_a = a();
  const MatchMap in_b = b();
  ASSERT_FALSE(difference(voxelsOf(in_a.hitVoxels()), voxelsOf(in_b.hitVoxels())).empty());
  ASSERT_FALSE(difference(voxelsOf(in_b.hitVoxels()), voxelsOf(in_a.hitVoxels())).empty());
  for (const MatchMap& map : {joined(), readAgain(joined())}) {
    EXPECT_TRUE(
        sameVoxels(inEither(in_a.hitVoxels(), in_b.hitVoxels()), voxelsOf(map.hitVoxels())));
    EXPECT_TRUE(
        sameVoxels(inEither(in_a.edgeVoxels(), in_b.edgeVoxels()), voxelsOf(map.edgeVoxels())));
    for (int l = 1; l < map.levels(); ++l) {
      EXPECT_TRUE(
          sameVoxels(inEither(in_a.occupied(l), in_b.occupied(l)), voxelsOf(map.occupied(l))))
          << l;
    }
    ASSERT_EQ(map.edgeVoxels().voxelCount(), map.edges().size());
    for (const EdgeVoxel& edge : map.edges()) {
      EXPECT_TRUE(map.edgeVoxels().test(edge.voxel));
      EXPECT_NEAR(1.0F, edge.direction.norm(), 1e-4F);
    }
  }
}

TEST_P(Joined, HasTheSurfacesOfTheFirstAndElseOfTheSecond) {
  const MatchMap in_a = a();
  const MatchMap in_b = b();
  const MatchMap map = joined();
  size_t of_a = 0;
  size_t of_b = 0;
  for (const VoxelIndex& v : voxelsOf(map.occupied(1))) {
    const bool first = in_a.surfaces().isSelected(v);
    const SurfaceLevel& from = first ? in_a.surfaces() : in_b.surfaces();
    ASSERT_EQ(from.isSelected(v), map.surfaces().isSelected(v));
    if (!from.isSelected(v)) continue;
    ++(first ? of_a : of_b);
    const uint32_t slot = map.surfaces().slotOf(v);
    ASSERT_TRUE(sameSurface(from.surface(from.slotOf(v)), map.surfaces().surface(slot)));
    ASSERT_EQ(from.hasBack(from.slotOf(v)), map.surfaces().hasBack(slot));
    if (!from.hasBack(from.slotOf(v))) continue;
    const Surface& back = from.surface(from.surface(from.slotOf(v)).back_surface);
    const uint32_t back_slot = map.surfaces().surface(slot).back_surface;
    ASSERT_TRUE(sameSurface(back, map.surfaces().surface(back_slot)));
  }
  EXPECT_GT(of_a, 0U);
  EXPECT_GT(of_b, 0U);
  EXPECT_EQ(of_a + of_b, map.surfaces().selectedCount());
}

TEST_P(Joined, HasThePlanesOfTheFirstAndElseOfTheSecond) {
  const MatchMap in_a = a();
  const MatchMap in_b = b();
  const MatchMap map = joined();
  for (int l = MatchMap::kFinestPlanes; l <= MatchMap::kCoarsestPlanes; ++l) {
    size_t of_b = 0;
    map.planes(l).forEachVoxel([&](const VoxelIndex& v, const VoxelPlanes& planes) {
      const VoxelPlanes* from = in_a.planes(l).find(v);
      if (from == nullptr) {
        from = in_b.planes(l).find(v);
        ++of_b;
      }
      ASSERT_NE(nullptr, from);
      ASSERT_EQ(from->count, planes.count);
      EXPECT_EQ(from->sides[0].normal, planes.sides[0].normal);
      EXPECT_EQ(from->sides[1].offset, planes.sides[1].offset);
    });
    const bool some = GetParam() != Representation::kEdges;
    EXPECT_EQ(some, of_b > 0) << l;
    EXPECT_EQ(some, in_a.planes(l).count() > 0) << l;
    EXPECT_EQ(in_a.planes(l).count() + of_b, map.planes(l).count());
    EXPECT_EQ(map.planes(l).count(), readAgain(map).planes(l).count());
  }
}

TEST_P(Joined, WithItselfIsTheSame) {
  const MatchMap map = readAgain(a());
  EXPECT_EQ(encoded(map, GetParam()), encoded(unionOf(map, map, GetParam()), GetParam()));
}

TEST_P(Joined, LocatesTheScansOfBoth) {
  Localizer localizer(config_, readAgain(joined()));
  std::vector<double> errors;
  for (size_t i = 0; i < maps().scans.size(); ++i) {
    const ScanResult result = localizer.process(maps().scans[i]);
    ASSERT_TRUE(result.located()) << i;
    errors.push_back(differenceOf(maps().poses[i], result.T_map_sensor).metres);
  }
  RecordProperty("median_mm", std::to_string(1e3 * quantile(errors, 0.5)));
  RecordProperty("greatest_mm", std::to_string(1e3 * quantile(errors, 1.0)));
  EXPECT_LT(quantile(errors, 0.5), 0.03);
  EXPECT_LT(quantile(errors, 1.0), 0.1);
}

INSTANTIATE_TEST_SUITE_P(Representations, Joined,
                         ::testing::Values(Representation::kSparse, Representation::kAll,
                                           Representation::kEdges));

TEST(MapUnion, VoxelsOfOtherSizesAreRefused) {
  const MatchMap map(0.2, 6.4);
  EXPECT_THROW(unionOf(map, MatchMap(0.4, 6.4), Representation::kSparse), std::invalid_argument);
  EXPECT_THROW(unionOf(map, MatchMap(0.2, 3.2), Representation::kSparse), std::invalid_argument);
  EXPECT_EQ(0U, unionOf(map, map, Representation::kEdges).hitVoxels().voxelCount());
}

}  // namespace
}  // namespace edgevox::test
