// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversions/point_times.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "ros/conversions/point_cloud.hpp"
#include "tools/cloud_message.hpp"

namespace edgevox {
namespace {

using sensor_msgs::PointCloud2;
using test::Field;

constexpr size_t kPoints = 400;
constexpr double kStamp = 1600000000.5;  // [s], of makeCloud()
constexpr size_t kTimeOffset = 16;

/// From 0 to 0.1 s.
double timeOf(size_t point) { return 0.1 * static_cast<double>(point) / (kPoints - 1); }

template <typename T>
constexpr uint8_t kType = std::is_same_v<T, float>    ? Field::FLOAT32
                          : std::is_same_v<T, double> ? Field::FLOAT64
                                                      : Field::UINT32;

/// A cloud of which point i has the time value(i).
template <typename T, typename Value>
PointCloud2 timedCloud(const Value& value) {
  std::vector<Eigen::Vector3f> points;
  for (size_t i = 0; i < kPoints; ++i)
    points.emplace_back(1.0F + 0.01F * static_cast<float>(i), 2, 3);
  PointCloud2 cloud = test::makeCloud(points, 24);
  cloud.fields.push_back(test::makeField("time", kTimeOffset, kType<T>));
  for (size_t i = 0; i < kPoints; ++i) {
    const double time = value(i);
    test::put(cloud, 0, i, kTimeOffset,
              static_cast<T>(std::is_integral_v<T> ? std::round(time) : time));
  }
  return cloud;
}

CheckedCloud read(const PointCloud2& cloud, const VoxelizerConfig& config = {}) {
  return std::get<CheckedCloud>(readCloud(cloud, config));
}

template <typename T>
double secondsOf(const PointCloud2& cloud, const TimeField& field, size_t point) {
  T value;
  std::memcpy(&value, &cloud.data[point * cloud.point_step + field.offset], sizeof(T));
  return (static_cast<double>(value) - field.start) * field.unit;
}

/// That point i has the time `first` + timeOf(i).
template <typename T>
void expectTimes(const PointCloud2& cloud, const CheckedCloud& checked, double first,
                 double precision) {
  ASSERT_TRUE(checked.view.time.present) << checked.note;
  EXPECT_EQ(checked.time_field, "time");
  for (size_t i = 0; i < kPoints; ++i) {
    ASSERT_NEAR(secondsOf<T>(cloud, checked.view.time, i), first + timeOf(i), precision) << i;
  }
}

/// Counted from the stamp, in each unit.
template <typename T>
void expectAllUnits(double least_unit, double precision) {
  for (const double unit : {1.0, 1e-3, 1e-6, 1e-9}) {
    if (unit > least_unit) continue;
    const PointCloud2 cloud = timedCloud<T>([&](size_t i) { return timeOf(i) / unit; });
    const CheckedCloud checked = read(cloud);
    EXPECT_EQ(checked.note, "");
    EXPECT_EQ(checked.view.time.unit, unit);
    expectTimes<T>(cloud, checked, 0.0, precision);
  }
}

TEST(PointTimes, TheUnitIsFoundFromTheSpanOfTheSweep) {
  expectAllUnits<float>(1.0, 1e-7);
  expectAllUnits<double>(1.0, 1e-12);
  expectAllUnits<uint32_t>(1e-6, 1e-6);
}

TEST(PointTimes, OfTheEpochInAnyUnit) {
  for (const double unit : {1.0, 1e-3, 1e-6, 1e-9}) {
    const PointCloud2 cloud =
        timedCloud<double>([&](size_t i) { return (kStamp + timeOf(i)) / unit; });
    const CheckedCloud checked = read(cloud);
    EXPECT_EQ(checked.note, "");
    EXPECT_EQ(checked.view.time.unit, unit);
    expectTimes<double>(cloud, checked, 0.0, 5e-7);
  }
}

TEST(PointTimes, BeforeTheStamp) {
  const PointCloud2 cloud = timedCloud<float>([](size_t i) { return timeOf(i) - 0.1; });
  expectTimes<float>(cloud, read(cloud), -0.1, 1e-7);
}

/// Of 1.3 ms: its unit cannot be told from its length.
TEST(PointTimes, PacketsHaveTheUsualUnitOfTheirType) {
  const PointCloud2 nanoseconds =
      timedCloud<uint32_t>([](size_t i) { return 0.013e9 * timeOf(i); });
  EXPECT_EQ(read(nanoseconds).view.time.unit, 1e-9);
  const PointCloud2 seconds = timedCloud<float>([](size_t i) { return 0.013 * timeOf(i); });
  EXPECT_EQ(read(seconds).view.time.unit, 1.0);
}

TEST(PointTimes, OfAnotherClockCountFromTheFirstOrLastPoint) {
  for (const double unit : {1.0, 1e-9}) {
    const PointCloud2 cloud =
        timedCloud<double>([&](size_t i) { return (kStamp - 1e8 + timeOf(i)) / unit; });
    const CheckedCloud checked = read(cloud);
    EXPECT_NE(checked.note.find("of another clock"), std::string::npos) << checked.note;
    EXPECT_NE(checked.note.find("'time', float64"), std::string::npos) << checked.note;
    expectTimes<double>(cloud, checked, 0.0, 5e-7);
    VoxelizerConfig config;
    config.stamp_at = StampAt::kLast;
    EXPECT_EQ(read(cloud, config).note, "");
    expectTimes<double>(cloud, read(cloud, config), -0.1, 5e-7);
  }
  // Nanoseconds since the sensor was switched on, 3 s ago.
  const PointCloud2 cloud = timedCloud<uint32_t>([](size_t i) { return 3e9 + 1e9 * timeOf(i); });
  expectTimes<uint32_t>(cloud, read(cloud), 0.0, 1e-8);
}

TEST(PointTimes, TheStampMayBeThatOfTheFirstOrLastPoint) {
  const PointCloud2 cloud = timedCloud<float>([](size_t i) { return 0.02 + timeOf(i); });
  expectTimes<float>(cloud, read(cloud), 0.02, 1e-7);
  VoxelizerConfig config;
  config.stamp_at = StampAt::kFirst;
  expectTimes<float>(cloud, read(cloud, config), 0.0, 1e-7);
  config.stamp_at = StampAt::kLast;
  expectTimes<float>(cloud, read(cloud, config), -0.1, 1e-7);
}

TEST(PointTimes, AUnitThatIsGivenIsTaken) {
  // Of a slow scanner, 1 s a sweep in ms, of which the part seen takes 1.5 ms.
  const PointCloud2 cloud = timedCloud<float>([](size_t i) { return 15.0 * timeOf(i); });
  VoxelizerConfig config;
  config.time_unit = TimeUnit::kMilliseconds;
  EXPECT_EQ(read(cloud, config).view.time.unit, 1e-3);
  config.time_unit = TimeUnit::kNone;
  const CheckedCloud without = read(cloud, config);
  EXPECT_FALSE(without.view.time.present);
  EXPECT_EQ(without.time_field, "");
  EXPECT_EQ(without.note, "");
}

TEST(PointTimes, AFewWrongOnesDoNotCount) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double wrong : {0.0, 1e30, nan}) {
    const PointCloud2 cloud =
        timedCloud<double>([&](size_t i) { return i % 25 == 7 ? wrong : kStamp + timeOf(i); });
    const CheckedCloud checked = read(cloud);
    ASSERT_TRUE(checked.view.time.present) << wrong;
    EXPECT_EQ(checked.note, "");
    EXPECT_NEAR(secondsOf<double>(cloud, checked.view.time, kPoints - 1), 0.1, 1e-6);
    VoxelizerConfig config;
    const VoxelScan scan = Voxelizer(config, 0.2).voxelize(checked.view);
    EXPECT_EQ(scan.dropped.bad_time, kPoints / 25);
  }
}

TEST(PointTimes, ManyWrongOnesAreNotUsedWithWords) {
  for (const double wrong : {0.0, 1e30}) {
    const PointCloud2 cloud =
        timedCloud<double>([&](size_t i) { return i % 10 == 7 ? wrong : kStamp + timeOf(i); });
    const CheckedCloud checked = read(cloud);
    EXPECT_FALSE(checked.view.time.present) << wrong;
    EXPECT_EQ(checked.time_field, "");
    EXPECT_NE(checked.note.find("voxelizer/time_unit"), std::string::npos) << checked.note;
    const VoxelScan scan = Voxelizer({}, 0.2).voxelize(checked.view);
    EXPECT_EQ(scan.dropped.total(), 0U);
  }
}

TEST(PointTimes, PointsWithoutAReturnAreNotAsked) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float coordinate : {0.0F, nan}) {
    PointCloud2 cloud =
        timedCloud<double>([](size_t i) { return i % 2 == 0 ? 0.0 : kStamp + timeOf(i); });
    for (size_t i = 0; i < kPoints; i += 2) {
      for (size_t axis = 0; axis < 3; ++axis) test::put(cloud, 0, i, 4 * axis, coordinate);
    }
    const CheckedCloud checked = read(cloud);
    ASSERT_TRUE(checked.view.time.present);
    EXPECT_EQ(checked.note, "");
    EXPECT_NEAR(secondsOf<double>(cloud, checked.view.time, kPoints - 1), 0.1, 1e-6);
  }
}

TEST(PointTimes, OneTimeForAllPoints) {
  const PointCloud2 cloud = timedCloud<double>([](size_t) { return kStamp; });
  const CheckedCloud checked = read(cloud);
  ASSERT_TRUE(checked.view.time.present);
  EXPECT_EQ(secondsOf<double>(cloud, checked.view.time, 5), 0.0);
}

}  // namespace
}  // namespace edgevox
