// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "edgevox/scan/voxelizer.hpp"
#include "support/random.hpp"

namespace edgevox::test {
namespace {

constexpr double kMapVoxel = 0.1;  // [m]; the scan's is half of it
constexpr double kStamp = 1.7e9;   // [s]
const VoxelizerConfig kConfig;     // 0.5 to 120 m

struct TimedPoint {
  Eigen::Vector3d position;  ///< [m]
  double time = 0.0;         ///< [s] from the stamp
};

/// The bytes of a cloud, with its view.
struct RawCloud {
  std::vector<uint8_t> bytes;
  CloudView view;

  void finish() { view.data = bytes.data(); }
};

struct RawLayout {
  size_t height = 1;
  size_t point_step = 32;
  size_t row_padding = 0;
  std::array<size_t, 3> xyz_offset{{0, 4, 8}};
  Scalar xyz_type = Scalar::kFloat32;
  TimeField time;
};

template <typename T>
void store(uint8_t* at, double value) {
  const auto typed = static_cast<T>(value);
  std::memcpy(at, &typed, sizeof(T));
}

void storeAs(Scalar type, uint8_t* at, double value) {
  if (type == Scalar::kFloat32) store<float>(at, value);
  if (type == Scalar::kFloat64) store<double>(at, value);
  if (type == Scalar::kUint32) store<uint32_t>(at, std::round(value));
}

RawCloud rawCloud(const std::vector<TimedPoint>& points, const RawLayout& layout) {
  RawCloud cloud;
  CloudView& view = cloud.view;
  view.stamp = kStamp;
  view.frame = "lidar";
  view.height = layout.height;
  view.width = points.size() / layout.height;
  view.point_step = layout.point_step;
  view.row_step = view.width * view.point_step + layout.row_padding;
  view.xyz_offset = layout.xyz_offset;
  view.xyz_type = layout.xyz_type;
  view.time = layout.time;
  cloud.bytes.assign(view.height * view.row_step, 0xff);  // NaN where nothing is written
  for (size_t i = 0; i < points.size(); ++i) {
    const size_t row = i / view.width;
    uint8_t* at = cloud.bytes.data() + row * view.row_step + (i % view.width) * view.point_step;
    for (size_t axis = 0; axis < 3; ++axis) {
      storeAs(view.xyz_type, at + view.xyz_offset[axis],
              points[i].position[static_cast<Eigen::Index>(axis)]);
    }
    if (!view.time.present) continue;
    storeAs(view.time.type, at + view.time.offset,
            points[i].time / view.time.unit + view.time.start);
  }
  cloud.finish();
  return cloud;
}

/// Coordinates are floats, all in range.
std::vector<TimedPoint> randomPoints(uint32_t seed, size_t count) {
  Random random(seed);
  std::vector<TimedPoint> points;
  while (points.size() < count) {
    TimedPoint point;
    point.position = random.vectorIn(-2.0, 2.0).cast<float>().cast<double>();
    point.time = random.uniform(0.0, 0.1);
    if (point.position.norm() > 0.6) points.push_back(point);
  }
  return points;
}

struct Mean {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double time = 0.0;
  uint32_t count = 0;
};

std::map<VoxelIndex, Mean> bruteForce(const std::vector<TimedPoint>& points, double size) {
  std::map<VoxelIndex, Mean> voxels;
  for (const TimedPoint& point : points) {
    const Eigen::Vector3d scaled = (point.position * (1.0 / size)).array().floor();
    Mean& mean = voxels[{int32_t(scaled.x()), int32_t(scaled.y()), int32_t(scaled.z())}];
    mean.position += point.position;
    mean.time += point.time;
    ++mean.count;
  }
  for (auto& [index, mean] : voxels) {
    mean.position /= mean.count;
    mean.time /= mean.count;
  }
  return voxels;
}

/// The voxels of the scan are those of the points, each once.
void expectVoxelsOf(const std::vector<TimedPoint>& points, const VoxelScan& scan,
                    double time_tolerance) {
  const auto expected = bruteForce(points, scan.voxel_size);
  ASSERT_EQ(expected.size(), scan.voxels.size());
  std::set<VoxelIndex> seen;
  for (const ScanVoxel& voxel : scan.voxels) {
    ASSERT_TRUE(seen.insert(voxel.index).second);
    const auto entry = expected.find(voxel.index);
    ASSERT_TRUE(entry != expected.end());
    const Mean& mean = entry->second;
    ASSERT_EQ(mean.count, voxel.point_count);
    ASSERT_LT((voxel.centroid.cast<double>() - mean.position).norm(), 1e-6);
    ASSERT_NEAR(mean.time, voxel.time_offset, time_tolerance);
  }
}

VoxelScan voxelize(const RawCloud& cloud) {
  return Voxelizer(kConfig, kMapVoxel).voxelize(cloud.view);
}

void expectSameVoxels(const VoxelScan& a, const VoxelScan& b) {
  ASSERT_EQ(a.voxels.size(), b.voxels.size());
  for (size_t i = 0; i < a.voxels.size(); ++i) {
    ASSERT_EQ(a.voxels[i].index, b.voxels[i].index);
    ASSERT_EQ(a.voxels[i].centroid, b.voxels[i].centroid);
    ASSERT_EQ(a.voxels[i].time_offset, b.voxels[i].time_offset);
    ASSERT_EQ(a.voxels[i].point_count, b.voxels[i].point_count);
  }
}

RawLayout withTime(Scalar type, double unit, double start = 0.0) {
  RawLayout layout;
  layout.time = {true, 16, type, unit, start};
  return layout;
}

RawLayout float64Coordinates() {
  RawLayout layout;
  layout.xyz_type = Scalar::kFloat64;
  layout.xyz_offset = {{0, 8, 16}};
  return layout;
}

std::vector<TimedPoint> withoutTimes(std::vector<TimedPoint> points) {
  for (TimedPoint& point : points) point.time = 0.0;
  return points;
}

TEST(Voxelizer, EveryPointLandsInOneVoxel) {
  const auto points = withoutTimes(randomPoints(1, 20000));
  const VoxelScan scan = voxelize(rawCloud(points, {}));
  expectVoxelsOf(points, scan, 0.0);
  const auto add = [](uint64_t sum, const ScanVoxel& v) { return sum + v.point_count; };
  EXPECT_EQ(20000U, std::accumulate(scan.voxels.begin(), scan.voxels.end(), uint64_t{0}, add));
  EXPECT_EQ(20000U, scan.points_read);
  EXPECT_EQ(0U, scan.dropped.total());
}

TEST(Voxelizer, CentroidsLieInTheirVoxels) {
  const VoxelScan scan = voxelize(rawCloud(randomPoints(2, 20000), {}));
  for (const ScanVoxel& voxel : scan.voxels) {
    const Eigen::Vector3d from_centre =
        voxel.centroid.cast<double>() - voxelCentre(voxel.index, scan.voxel_size);
    ASSERT_LE(from_centre.cwiseAbs().maxCoeff(), scan.voxel_size / 2 + 1e-6);
  }
}

TEST(Voxelizer, VoxelsAreHalfTheMaps) {
  const VoxelScan scan = voxelize(rawCloud({{{2.01, 0, 0}}, {{2.03, 0, 0}}}, {}));
  EXPECT_DOUBLE_EQ(0.05, scan.voxel_size);
  ASSERT_EQ(1U, scan.voxels.size());
  EXPECT_EQ((VoxelIndex{40, 0, 0}), scan.voxels[0].index);
  EXPECT_EQ(2U, scan.voxels[0].point_count);
}

TEST(Voxelizer, VoxelsComeBlockByBlockInOrderOfTheirFirstPoint) {
  const auto points = randomPoints(15, 20000);
  const VoxelScan scan = voxelize(rawCloud(points, {}));
  std::map<VoxelIndex, size_t> first_of_block, first_of_voxel;
  for (size_t i = 0; i < points.size(); ++i) {
    const VoxelIndex v = voxelAt(points[i].position, 1.0 / scan.voxel_size);
    first_of_block.emplace(BlockLayout<16>::block(v), i);
    first_of_voxel.emplace(v, i);
  }
  const auto place = [&](const ScanVoxel& voxel) {
    return std::make_pair(first_of_block.at(BlockLayout<16>::block(voxel.index)),
                          first_of_voxel.at(voxel.index));
  };
  for (size_t i = 1; i < scan.voxels.size(); ++i) {
    ASSERT_LT(place(scan.voxels[i - 1]), place(scan.voxels[i]));
  }
}

TEST(Voxelizer, CopiesTheHeaderAndCountsClouds) {
  const RawCloud cloud = rawCloud(randomPoints(3, 10), {});
  Voxelizer voxelizer(kConfig, kMapVoxel);
  EXPECT_EQ(0U, voxelizer.voxelize(cloud.view).number);
  const VoxelScan scan = voxelizer.voxelize(cloud.view);
  EXPECT_EQ(1U, scan.number);
  EXPECT_EQ(kStamp, scan.stamp);
  EXPECT_EQ("lidar", scan.frame);
}

TEST(Voxelizer, TimesInFloatSeconds) {
  const auto points = randomPoints(4, 2000);
  expectVoxelsOf(points, voxelize(rawCloud(points, withTime(Scalar::kFloat32, 1.0))), 1e-7);
}

TEST(Voxelizer, TimesInUnsignedNanoseconds) {
  const auto points = randomPoints(5, 2000);
  expectVoxelsOf(points, voxelize(rawCloud(points, withTime(Scalar::kUint32, 1e-9))), 1e-7);
}

TEST(Voxelizer, TimesInDoubleSecondsSinceTheEpoch) {
  const auto points = randomPoints(6, 2000);
  const auto layout = withTime(Scalar::kFloat64, 1.0, kStamp);
  expectVoxelsOf(points, voxelize(rawCloud(points, layout)), 1e-6);  // a double's step is 2.4e-7
}

TEST(Voxelizer, NegativeTimes) {
  auto points = randomPoints(7, 2000);
  for (TimedPoint& point : points) point.time = -point.time;
  expectVoxelsOf(points, voxelize(rawCloud(points, withTime(Scalar::kFloat64, 1e-6))), 1e-7);
}

TEST(Voxelizer, PointsWithAWrongTimeAreDroppedAndCounted) {
  auto points = randomPoints(8, 300);
  points[10].time = 1e6;
  points[20].time = std::numeric_limits<double>::quiet_NaN();
  points[30].time = -std::numeric_limits<double>::infinity();
  const VoxelScan scan = voxelize(rawCloud(points, withTime(Scalar::kFloat32, 1.0)));
  EXPECT_EQ(3U, scan.dropped.bad_time);
  EXPECT_EQ(3U, scan.dropped.total());
  for (const int i : {30, 20, 10}) points.erase(points.begin() + i);
  expectVoxelsOf(points, scan, 1e-7);
}

TEST(Voxelizer, DropsByReason) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<TimedPoint> points = {{{nan, 1, 1}},        {{1, nan, 1}},  {{1, 1, nan}},
                                          {{inf, 1, 1}},        {{1, 1, -inf}}, {{0, 0, 0}},
                                          {{0.3, -0.3, 0.2}},   {{121, 0, 0}},  {{0, -1e30, 0}},
                                          {{1e30, 1e30, 1e30}}, {{1, 1, 1}}};
  for (const RawLayout& layout : {RawLayout{}, float64Coordinates()}) {
    const VoxelScan scan = voxelize(rawCloud(points, layout));
    EXPECT_EQ(11U, scan.points_read);
    EXPECT_EQ(5U, scan.dropped.not_finite);
    EXPECT_EQ(2U, scan.dropped.too_near);
    EXPECT_EQ(3U, scan.dropped.too_far);
    EXPECT_EQ(10U, scan.dropped.total());
    EXPECT_EQ(1U, scan.voxels.size());
  }
}

TEST(Voxelizer, DropsDoublesWhoseSquareOverflows) {
  const auto cloud = rawCloud({{{0, 1e300, 0}}}, float64Coordinates());
  EXPECT_EQ(1U, voxelize(cloud).dropped.too_far);
}

TEST(Voxelizer, KeepsPointsAtTheLimitsOfTheRange) {
  const std::vector<TimedPoint> points = {{{0.5, 0, 0}}, {{0, -120, 0}}};
  EXPECT_EQ(2U, voxelize(rawCloud(points, {})).voxels.size());
}

TEST(Voxelizer, RowsMayBePadded) {
  const auto points = withoutTimes(randomPoints(9, 1200));
  RawLayout layout;
  layout.height = 16;
  layout.row_padding = 52;
  expectVoxelsOf(points, voxelize(rawCloud(points, layout)), 0.0);
}

TEST(Voxelizer, CoordinatesMayBeDoubles) {
  const auto points = withoutTimes(randomPoints(10, 1200));
  expectVoxelsOf(points, voxelize(rawCloud(points, float64Coordinates())), 0.0);
}

TEST(Voxelizer, FieldsMayBeUnalignedAndInAnyOrder) {
  const auto points = randomPoints(11, 1200);
  RawLayout layout;
  layout.point_step = 27;
  layout.xyz_offset = {{9, 1, 5}};
  layout.time = {true, 17, Scalar::kFloat64, 1.0, false};
  expectVoxelsOf(points, voxelize(rawCloud(points, layout)), 1e-7);
}

TEST(Voxelizer, NegativeCoordinatesAreFloored) {
  const std::vector<TimedPoint> points = {{{-0.01, -0.99, -1.01}}};
  const VoxelScan scan = voxelize(rawCloud(points, {}));
  ASSERT_EQ(1U, scan.voxels.size());
  EXPECT_EQ((VoxelIndex{-1, -20, -21}), scan.voxels[0].index);
}

/// Floats beside the borders of voxels, on both sides of 0.
std::vector<TimedPoint> pointsAtBorders(uint32_t seed, size_t count, double size) {
  Random random(seed);
  std::vector<TimedPoint> points(count);
  for (TimedPoint& point : points) {
    for (int axis = 0; axis < 3; ++axis) {
      auto at = static_cast<float>(std::round(random.uniform(-600.0, 600.0)) * size);
      const int steps = static_cast<int>(random.uniform(0.0, 3.0));
      const float towards = random.uniform(-1.0, 1.0) < 0.0 ? -1e9F : 1e9F;
      for (int i = 0; i < steps; ++i) at = std::nextafter(at, towards);
      point.position[axis] = static_cast<double>(at);
    }
    if (point.position.norm() < 0.6) point.position.x() = 1.0;
  }
  return points;
}

TEST(Voxelizer, PointsAtBordersLandInTheirVoxels) {
  for (const double map_voxel : {0.1, 0.07, 0.3, 1.0 / 3.0}) {
    const auto points = pointsAtBorders(16, 100000, map_voxel / 2);
    const RawCloud cloud = rawCloud(points, {});
    const VoxelScan scan = Voxelizer({0.5, 1000.0}, map_voxel).voxelize(cloud.view);
    const auto expected = bruteForce(points, scan.voxel_size);
    ASSERT_EQ(expected.size(), scan.voxels.size());
    for (const ScanVoxel& voxel : scan.voxels) {
      const auto entry = expected.find(voxel.index);
      ASSERT_TRUE(entry != expected.end());
      ASSERT_EQ(entry->second.count, voxel.point_count);
    }
  }
}

TEST(Voxelizer, TheLeastBelowZeroIsBelowZero) {
  const double least = static_cast<double>(std::numeric_limits<float>::denorm_min());
  const VoxelScan scan = voxelize(rawCloud({{{-least, 1, -0.0}}, {{1, -1e-20, least}}}, {}));
  ASSERT_EQ(2U, scan.voxels.size());
  EXPECT_EQ((VoxelIndex{-1, 20, 0}), scan.voxels[0].index);
  EXPECT_EQ((VoxelIndex{20, -1, 0}), scan.voxels[1].index);
}

TEST(Voxelizer, DropsWhatNoGridHolds) {
  const RawCloud cloud = rawCloud({{{-5242.5, 0, 0}}, {{0, 5242.5, 0}}, {{0, 0, -5243.5}}}, {});
  const VoxelScan scan = Voxelizer({0.5, 10000.0}, 0.01).voxelize(cloud.view);  // 2^20 = 5243 m
  EXPECT_EQ(1U, scan.dropped.too_far);
  ASSERT_EQ(2U, scan.voxels.size());
  EXPECT_EQ((VoxelIndex{-1048500, 0, 0}), scan.voxels[0].index);
  EXPECT_EQ((VoxelIndex{0, 1048500, 0}), scan.voxels[1].index);
}

TEST(Voxelizer, DroppedPointsAmongOthersChangeNothing) {
  const auto points = randomPoints(17, 3000);
  Random random(18);
  std::vector<TimedPoint> mixed;
  for (const TimedPoint& point : points) {
    while (random.uniform(0.0, 1.0) < 0.3) mixed.push_back({Eigen::Vector3d::Zero(), 0.05});
    mixed.push_back(point);
  }
  const RawLayout layout = withTime(Scalar::kFloat32, 1.0);
  const VoxelScan scan = voxelize(rawCloud(mixed, layout));
  EXPECT_EQ(mixed.size() - points.size(), scan.dropped.too_near);
  expectSameVoxels(voxelize(rawCloud(points, layout)), scan);
}

TEST(Voxelizer, ASecondCloudIsVoxelizedAsByANewVoxelizer) {
  const auto layout = withTime(Scalar::kFloat32, 1.0);
  const RawCloud first = rawCloud(randomPoints(12, 5000), layout);
  const RawCloud second = rawCloud(randomPoints(13, 3000), layout);
  Voxelizer used(kConfig, kMapVoxel);
  used.voxelize(first.view);
  expectSameVoxels(voxelize(second), used.voxelize(second.view));
}

TEST(Voxelizer, ACloudOfTooManyPointsIsGivenUpWithWords) {
  std::vector<Eigen::Vector3f> points(101, Eigen::Vector3f(1, 2, 3));
  VoxelizerConfig config;
  config.max_points = 100;
  Voxelizer voxelizer(config, 0.2);
  const VoxelScan large = voxelizer.voxelize(viewOf(points, 1.0, "lidar"));
  EXPECT_TRUE(large.voxels.empty());
  for (const char* word : {"101 points", "more than 100", "voxelizer/max_points"}) {
    EXPECT_NE(std::string::npos, large.too_large.find(word)) << large.too_large;
  }
  points.pop_back();
  const VoxelScan allowed = voxelizer.voxelize(viewOf(points, 1.0, "lidar"));
  EXPECT_EQ(1U, allowed.voxels.size());
  EXPECT_TRUE(allowed.too_large.empty());
}

/// A voxel a point: `blocks` blocks of `each` voxels.
std::vector<Eigen::Vector3f> pointsInVoxels(int blocks, int each) {
  std::vector<Eigen::Vector3f> points;
  for (int b = 0; b < blocks; ++b) {
    for (int i = 0; i < each; ++i) {
      points.emplace_back(1.65F + 1.6F * static_cast<float>(b),
                          0.05F + 0.1F * static_cast<float>(i), 0.05F);
    }
  }
  return points;
}

TEST(Voxelizer, AScanOfTooManyVoxelsIsGivenUpWithWords) {
  VoxelizerConfig config;
  config.max_voxels = 60;
  Voxelizer voxelizer(config, 0.2);
  for (const auto& [blocks, each] : {std::pair<int, int>{61, 1}, {7, 10}}) {
    const VoxelScan large = voxelizer.voxelize(viewOf(pointsInVoxels(blocks, each), 1.0, ""));
    EXPECT_TRUE(large.voxels.empty());
    for (const char* word : {"more than 60 voxels", "voxel_size", "max_range"}) {
      EXPECT_NE(std::string::npos, large.too_large.find(word)) << large.too_large;
    }
    const auto allowed = voxelizer.voxelize(viewOf(pointsInVoxels(blocks - 1, each), 1.0, ""));
    EXPECT_EQ(60U, allowed.voxels.size());
    EXPECT_TRUE(allowed.too_large.empty());
  }
}

TEST(Voxelizer, AnEmptyCloudGivesAnEmptyScan) {
  const VoxelScan scan = Voxelizer(kConfig, kMapVoxel).voxelize(viewOf({}, kStamp, "lidar"));
  EXPECT_TRUE(scan.voxels.empty());
  EXPECT_EQ(0U, scan.points_read);
  EXPECT_EQ("lidar", scan.frame);
}

TEST(Voxelizer, ViewOfPackedPoints) {
  const auto points = withoutTimes(randomPoints(14, 500));
  std::vector<Eigen::Vector3f> packed;
  for (const TimedPoint& point : points) packed.push_back(point.position.cast<float>());
  Voxelizer voxelizer(kConfig, kMapVoxel);
  expectVoxelsOf(points, voxelizer.voxelize(viewOf(packed, kStamp, "lidar")), 0.0);
}

}  // namespace
}  // namespace edgevox::test
