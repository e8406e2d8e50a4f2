// SPDX-License-Identifier: BSD-3-Clause
// Copies of a map that share its memory against maps that never were copied.
#include <algorithm>
#include <atomic>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "edgevox/map/map_builder.hpp"
#include "support/scans.hpp"
#include "support/voxel_sets.hpp"

namespace edgevox::test {
namespace {

constexpr int kScans = 24;
constexpr size_t kHalf = 12;
constexpr double kRange = 5.0;  // [m]

Eigen::Vector3d roomOf(size_t scan) { return {scan / 5 % 2 == 0 ? 0.0 : 30.0, 0.0, 0.0}; }

/// All that can be read of a map, bit for bit.
class Content {
 public:
  explicit Content(const MapBuilder& map) {
    for (const VoxelIndex& v : voxelsOf(map.hitVoxels())) add(v, map.centroid(v));
    for (const VoxelIndex& v : voxelsOf(map.edgeVoxels())) add(v, map.centroid(v));
    for (int level = 1; level < map.levels(); ++level) {
      for (const VoxelIndex& v : voxelsOf(map.matchMap().occupied(level))) {
        add(v, Eigen::Vector3d::Zero());
        if (level == 1) addSurfaces(map, v);
      }
    }
    for (const size_t n : {map.hitVoxelCount(), map.frozenRegions(), map.thawedRegions()}) add(n);
  }

  bool operator==(const Content& other) const { return bytes_ == other.bytes_; }
  size_t size() const { return bytes_.size(); }

 private:
  template <typename Value>
  void add(const Value& value) {
    const auto* begin = reinterpret_cast<const char*>(&value);
    bytes_.insert(bytes_.end(), begin, begin + sizeof(Value));
  }
  void add(const VoxelIndex& v, const Eigen::Vector3d& at) {
    for (const int32_t i : {v.x, v.y, v.z}) add(i);
    for (const double x : {at.x(), at.y(), at.z()}) add(x);
  }

  void addSurfaces(const MapBuilder& map, const VoxelIndex& v) {
    const SurfaceLevel& surfaces = map.matchMap().surfaces();
    const uint32_t first = surfaces.slotOf(v);
    for (uint32_t slot = first; slot != Surface::kNone;
         slot = surfaces.surface(slot).back_surface) {
      add(map.moments().hasCell(slot));
      if (map.moments().hasCell(slot)) addCell(map.moments().cell(slot));
      const Surface& surface = surfaces.surface(slot);
      add(surface.information);
      for (int i = 0; i < 3; ++i) {
        add(surface.mean[i]);
        add(surface.side[i]);
      }
    }
  }

  void addCell(const MomentLevel::Cell& cell) {
    for (const auto& sums : {cell.sum, cell.view}) add(sums);
    add(cell.outer);
    for (const uint32_t n : {cell.count, uint32_t{cell.hits}, uint32_t{cell.edge_children}}) add(n);
    for (const bool flag : {cell.anchor, cell.stale, cell.is_back, cell.selected}) add(flag);
  }

  std::vector<char> bytes_;
};

MapConfig configOf(Representation representation, int clear_after, int freeze_after = 0) {
  MapConfig config;
  config.coarsest_voxel = 3.2;
  config.representation = representation;
  config.clear_after = clear_after;
  config.freeze_after = freeze_after;
  config.label_every = 2;
  return config;
}

MapBuilder makeMap(const MapConfig& config) {
  return MapBuilder(kScanMapVoxel, config, {}, 1, kRange);
}

/// Two rooms out of reach of one another, in turn.
std::vector<Centroids> scansOfRooms(uint32_t seed) {
  std::vector<Centroids> scans = randomScans(seed, kScans);
  for (size_t i = 0; i < scans.size(); ++i) {
    for (Eigen::Vector3d& point : scans[i]) point += roomOf(i);
  }
  return scans;
}

/// From within the scene, so that surfaces are seen from both sides and voxels through others.
void insert(const std::vector<Centroids>& scans, size_t begin, size_t end, MapBuilder& map) {
  for (size_t i = begin; i < end; ++i) {
    map.insert(scans[i], roomOf(i) + Eigen::Vector3d(1.0 + 0.1 * static_cast<double>(i), 1.5, 1.0));
  }
}

class Snapshot : public ::testing::TestWithParam<MapConfig> {
 protected:
  const std::vector<Centroids> scans_ = scansOfRooms(11);
};

TEST_P(Snapshot, StaysAsItWasAndItsOriginGoesOnAsIfThereWereNone) {
  MapBuilder alone = makeMap(GetParam());
  insert(scans_, 0, kHalf, alone);
  const Content middle(alone);
  ASSERT_GT(middle.size(), 100000U);
  insert(scans_, kHalf, kScans, alone);
  const Content end(alone);
  ASSERT_FALSE(end == middle);

  MapBuilder map = makeMap(GetParam());
  std::vector<MapBuilder> snapshots;
  for (size_t i = 0; i < kScans; ++i) {
    insert(scans_, i, i + 1, map);
    if (i % 3 == 2) snapshots.push_back(map);
  }
  EXPECT_EQ(GetParam().freeze_after > 0, map.frozenRegions() > 0);
  EXPECT_EQ(GetParam().freeze_after > 0, map.thawedRegions() > 0);
  EXPECT_TRUE(Content(map) == end);
  EXPECT_EQ(alone.bytes(), map.bytes()) << "by which a map is full";
  MapBuilder& then = snapshots[kHalf / 3 - 1];
  EXPECT_TRUE(Content(then) == middle);
  insert(scans_, kHalf, kScans, then);  // a snapshot is a map as well
  EXPECT_TRUE(Content(then) == end);
  EXPECT_TRUE(Content(map) == end);
  alone.label();
  map.label();
  EXPECT_TRUE(Content(map) == Content(alone));
}

/// To be run with ThreadSanitizer, see tsan.supp.
TEST_P(Snapshot, IsReadAndLabelledWhileItsOriginGoesOn) {
  MapBuilder alone = makeMap(GetParam());
  std::vector<std::unique_ptr<Content>> expected;
  MapBuilder map = makeMap(GetParam());
  for (size_t i = 0; i < kScans; ++i) {
    insert(scans_, i, i + 1, alone);
    MapBuilder labelled = alone;
    labelled.label();
    expected.push_back(std::make_unique<Content>(labelled));
  }
  std::vector<std::thread> readers;
  std::atomic<int> equal{0};
  for (size_t i = 0; i < kScans; ++i) {
    insert(scans_, i, i + 1, map);
    readers.emplace_back([&, i, snapshot = std::make_unique<MapBuilder>(map)]() mutable {
      snapshot->label();
      if (Content(*snapshot) == *expected[i]) ++equal;
      snapshot.reset();
    });
  }
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(kScans, equal);
  EXPECT_TRUE(Content(map) == Content(alone));
}

INSTANTIATE_TEST_SUITE_P(, Snapshot,
                         ::testing::Values(configOf(Representation::kSparse, 0),
                                           configOf(Representation::kSparse, 3),
                                           configOf(Representation::kSparse, 3, 2),
                                           configOf(Representation::kAll, 0),
                                           configOf(Representation::kRandom, 0),
                                           configOf(Representation::kEdges, 0, 2)));

TEST(ChangedBlocks, AreThoseThatDifferAndNoOthers) {
  const std::vector<Centroids> scans = randomScans(12, kScans);
  MapBuilder map = makeMap(configOf(Representation::kSparse, 0));
  insert(scans, 0, kHalf, map);
  const BitGrid<16> before = map.edgeVoxels();
  size_t changed = 0;
  map.edgeVoxels().forEachChangedBlock(before, [&](size_t) { ++changed; });
  EXPECT_EQ(0U, changed);
  insert(scans, kHalf, kScans, map);
  const BitGrid<16>& now = map.edgeVoxels();
  std::vector<VoxelIndex> expected;
  for (size_t slot = 0; slot < now.blockCount(); ++slot) {
    const auto* known = before.findBlock(now.blockIndex(slot));
    const bool differs =
        known != nullptr ? *known != now.block(slot) : !BlockLayout<16>::isEmpty(now.block(slot));
    if (differs) expected.push_back(now.blockIndex(slot));
  }
  std::vector<VoxelIndex> found;
  now.forEachChangedBlock(before, [&](size_t slot) { found.push_back(now.blockIndex(slot)); });
  EXPECT_FALSE(found.empty());
  EXPECT_TRUE(expected == found);
}

}  // namespace
}  // namespace edgevox::test
