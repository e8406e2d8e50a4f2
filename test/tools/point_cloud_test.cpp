// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversions/point_cloud.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "tools/cloud_message.hpp"

namespace edgevox {
namespace {

using sensor_msgs::PointCloud2;
using test::Field;
using test::makeCloud;
using test::makeField;
using test::put;

const std::vector<Eigen::Vector3f> kPoints = {{1, 2, 3}, {-4, 5, 6}, {7, -8, 9}, {3, 3, -3}};

CheckedCloud checkedOf(const PointCloud2& cloud) {
  const CloudReading reading = readCloud(cloud, VoxelizerConfig());
  if (const auto* error = std::get_if<CloudError>(&reading)) {
    ADD_FAILURE() << error->text;
    return {};
  }
  return std::get<CheckedCloud>(reading);
}

VoxelScan voxelized(const CloudView& view) {
  VoxelizerConfig config;
  config.min_range = 0;
  return Voxelizer(config, 0.2).voxelize(view);
}

void expectSamePoints(const PointCloud2& cloud) {
  const VoxelScan scan = voxelized(checkedOf(cloud).view);
  ASSERT_EQ(scan.voxels.size(), kPoints.size());
  for (size_t i = 0; i < kPoints.size(); ++i) {
    EXPECT_LT((scan.voxels[i].centroid - kPoints[i]).norm(), 1e-5F) << "point " << i;
  }
}

void expectFault(const PointCloud2& cloud, CloudFault fault,
                 const std::vector<std::string>& words) {
  const CloudReading reading = readCloud(cloud, VoxelizerConfig());
  ASSERT_TRUE(std::holds_alternative<CloudError>(reading));
  const auto& error = std::get<CloudError>(reading);
  EXPECT_STREQ(toString(error.fault), toString(fault));
  for (const std::string& word : words) {
    EXPECT_NE(error.text.find(word), std::string::npos) << "'" << word << "' in: " << error.text;
  }
}

/// The offsets of the voxels' times from the stamp, for a time field of a point of 24 bytes.
template <typename T>
std::vector<float> timeOffsets(const std::string& field, uint8_t type,
                               const std::vector<T>& values) {
  PointCloud2 cloud = makeCloud(kPoints, 24);
  cloud.fields.push_back(makeField(field, 16, type));
  for (size_t i = 0; i < values.size(); ++i) put(cloud, 0, i, 16, values[i]);
  const CheckedCloud checked = checkedOf(cloud);
  EXPECT_EQ(checked.time_field, field);
  EXPECT_EQ(checked.note, "");
  std::vector<float> offsets;
  for (const ScanVoxel& voxel : voxelized(checked.view).voxels) {
    offsets.push_back(voxel.time_offset);
  }
  return offsets;
}

void expectNear(const std::vector<float>& offsets, const std::vector<float>& expected) {
  ASSERT_EQ(offsets.size(), expected.size());
  for (size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(offsets[i], expected[i], 1e-6F) << i;
}

const std::vector<float> kOffsets = {0.0F, 0.025F, 0.05F, 0.1F};

TEST(PointCloud, viewOfPackedPoints) {
  const PointCloud2 cloud = makeCloud(kPoints);
  const CheckedCloud checked = checkedOf(cloud);
  EXPECT_EQ(checked.view.stamp, 1600000000.5);
  EXPECT_EQ(checked.view.frame, "lidar");
  EXPECT_EQ(checked.view.data, cloud.data.data());
  EXPECT_FALSE(checked.view.time.present);
  EXPECT_EQ(checked.time_field, "");
  EXPECT_EQ(checked.note, "");
  expectSamePoints(cloud);
}

TEST(PointCloud, paddedPoints) { expectSamePoints(makeCloud(kPoints, 48)); }

TEST(PointCloud, paddedRows) {
  PointCloud2 cloud = makeCloud(kPoints);
  cloud.width = cloud.height = 2;
  cloud.row_step = 2 * cloud.point_step + 7;
  cloud.data.assign(2 * cloud.row_step, 0xff);
  for (size_t i = 0; i < 4; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      put(cloud, i / 2, i % 2, 4 * static_cast<size_t>(axis), kPoints[i][axis]);
    }
  }
  expectSamePoints(cloud);
}

TEST(PointCloud, doubleCoordinatesInAnyOrder) {
  PointCloud2 cloud = makeCloud(kPoints, 32);
  cloud.fields = {makeField("z", 0, Field::FLOAT64), makeField("intensity", 24, Field::FLOAT32),
                  makeField("x", 8, Field::FLOAT64), makeField("y", 16, Field::FLOAT64)};
  for (size_t i = 0; i < kPoints.size(); ++i) {
    put(cloud, 0, i, 8, static_cast<double>(kPoints[i].x()));
    put(cloud, 0, i, 16, static_cast<double>(kPoints[i].y()));
    put(cloud, 0, i, 0, static_cast<double>(kPoints[i].z()));
  }
  expectSamePoints(cloud);
}

TEST(PointCloud, secondsFromTheStamp) {
  expectNear(timeOffsets<float>("time", Field::FLOAT32, kOffsets), kOffsets);
}

TEST(PointCloud, nanosecondsFromTheStamp) {
  for (const char* field : {"t", "offset_time", "timeOffset", "time_offset"}) {
    expectNear(timeOffsets<uint32_t>(field, Field::UINT32, {0, 25000000, 50000000, 100000000}),
               kOffsets);
  }
}

TEST(PointCloud, secondsOfTheEpoch) {
  constexpr double kStamp = 1600000000.5;
  for (const char* field : {"timestamp", "time_stamp", "timeStamp"}) {
    expectNear(timeOffsets<double>(field, Field::FLOAT64,
                                   {kStamp, kStamp + 0.025, kStamp + 0.05, kStamp + 0.1}),
               kOffsets);
  }
}

TEST(PointCloud, nanosecondsOfTheEpoch) {
  constexpr double kStamp = 1600000000.5e9;
  expectNear(timeOffsets<double>("timestamp", Field::FLOAT64,
                                 {kStamp, kStamp + 25e6, kStamp + 50e6, kStamp + 100e6}),
             kOffsets);
}

TEST(PointCloud, smallDoublesAreSecondsFromTheStamp) {
  expectNear(timeOffsets<double>("time", Field::FLOAT64, {0.0, 0.025, 0.05, 0.1}), kOffsets);
}

TEST(PointCloud, unknownTimeTypeIsANote) {
  PointCloud2 cloud = makeCloud(kPoints, 24);
  cloud.fields.push_back(makeField("timestamp", 16, Field::UINT16));
  const CheckedCloud checked = checkedOf(cloud);
  EXPECT_FALSE(checked.view.time.present);
  EXPECT_NE(checked.note.find("'timestamp' is uint16"), std::string::npos) << checked.note;
}

TEST(PointCloud, usableTimeIsPreferred) {
  PointCloud2 cloud = makeCloud(kPoints, 24);
  cloud.fields.push_back(makeField("time", 12, Field::INT32));
  cloud.fields.push_back(makeField("t", 16, Field::UINT32));
  for (size_t i = 0; i < kPoints.size(); ++i) put<uint32_t>(cloud, 0, i, 16, 0);
  const CheckedCloud checked = checkedOf(cloud);
  EXPECT_EQ(checked.time_field, "t");
  EXPECT_EQ(checked.note, "");
}

TEST(PointCloud, stampsThatRosCannotCarry) {
  constexpr uint32_t kLastSecond = std::numeric_limits<uint32_t>::max();
  for (const uint32_t seconds : {kLastSecond, kLastSecond - 28, kLastSecond - 86400}) {
    PointCloud2 cloud = makeCloud(kPoints);
    cloud.header.stamp.sec = seconds;
    expectFault(cloud, CloudFault::kStamp,
                {std::to_string(seconds) + " s", "too late", "frame 'lidar'", "driver's clock"});
  }
  PointCloud2 cloud = makeCloud(kPoints);
  cloud.header.stamp.nsec = 1000000000;
  expectFault(cloud, CloudFault::kStamp, {"1000000000 ns"});
  cloud.header.stamp = ros::Time();
  expectFault(cloud, CloudFault::kStamp, {"never set"});
  for (const auto& good : {ros::Time(0, 1), ros::Time(0, 100000000), ros::Time(1 << 31, 999999999),
                           ros::Time(4260000000, 0)}) {
    cloud.header.stamp = good;
    EXPECT_EQ(checkedOf(cloud).view.stamp, good.toSec());
  }
}

TEST(PointCloud, emptyCloud) {
  expectFault(makeCloud({}), CloudFault::kEmpty, {"no points", "frame 'lidar'"});
}

TEST(PointCloud, bigEndian) {
  PointCloud2 cloud = makeCloud(kPoints);
  cloud.is_bigendian = 1;
  expectFault(cloud, CloudFault::kBigEndian, {"big-endian"});
}

TEST(PointCloud, missingCoordinate) {
  PointCloud2 cloud = makeCloud(kPoints);
  cloud.fields.pop_back();
  expectFault(cloud, CloudFault::kMissingCoordinate, {"no field 'z'", "x, y"});
  cloud.fields.clear();
  expectFault(cloud, CloudFault::kMissingCoordinate, {"no field 'x'", "none"});
}

TEST(PointCloud, duplicateCoordinate) {
  PointCloud2 cloud = makeCloud(kPoints, 16);
  cloud.fields.push_back(makeField("y", 12, Field::FLOAT32));
  expectFault(cloud, CloudFault::kDuplicateCoordinate, {"'y' is there 2 times"});
}

TEST(PointCloud, unsupportedCoordinateTypes) {
  PointCloud2 cloud = makeCloud(kPoints, 32);
  cloud.fields[1].datatype = Field::INT16;
  expectFault(cloud, CloudFault::kCoordinateType, {"'y' is int16", "float32"});
  cloud.fields[1].datatype = 42;
  expectFault(cloud, CloudFault::kCoordinateType, {"unknown type 42"});
  cloud.fields[1].datatype = Field::FLOAT64;
  expectFault(cloud, CloudFault::kCoordinateType, {"different types", "float64"});
}

TEST(PointCloud, fieldOutsideItsPoint) {
  PointCloud2 cloud = makeCloud(kPoints);
  cloud.fields[2].offset = 9;
  expectFault(cloud, CloudFault::kPointStep, {"'z'", "byte 9", "point_step 12"});
  cloud.fields[2].offset = std::numeric_limits<uint32_t>::max();
  expectFault(cloud, CloudFault::kPointStep, {"'z'"});
  cloud = makeCloud(kPoints);
  cloud.fields.push_back(makeField("time", 12, Field::FLOAT32));
  expectFault(cloud, CloudFault::kPointStep, {"'time'"});
  cloud = makeCloud(kPoints);
  cloud.point_step = 0;
  expectFault(cloud, CloudFault::kPointStep, {"point_step 0"});
}

TEST(PointCloud, rowStepOfPackedPointsMayBeAnything) {
  PointCloud2 cloud = makeCloud(kPoints);
  for (const uint32_t height : {1U, 2U, 4U}) {
    cloud.height = height;
    cloud.width = 4 / height;
    for (const uint32_t row_step : {0U, 1U, 47U, 48U, 96U}) {
      cloud.row_step = row_step;
      expectSamePoints(cloud);
    }
  }
  cloud = makeCloud(kPoints);
  cloud.row_step = 0;
  cloud.data.push_back(0);  // one row needs none
  expectSamePoints(cloud);
}

TEST(PointCloud, rowStepTooSmall) {
  PointCloud2 cloud = makeCloud(kPoints);
  cloud.width = cloud.height = 2;
  cloud.data.resize(60);
  for (const uint32_t row_step : {0U, 23U}) {
    cloud.row_step = row_step;
    expectFault(cloud, CloudFault::kRowStep,
                {"row_step " + std::to_string(row_step), "24 bytes", "correct the driver"});
  }
}

TEST(PointCloud, dataTooShort) {
  PointCloud2 cloud = makeCloud(kPoints);
  cloud.data.pop_back();
  expectFault(cloud, CloudFault::kDataSize, {"48 bytes", "hold 47"});
  cloud = makeCloud(kPoints);
  cloud.height = 2;
  expectFault(cloud, CloudFault::kDataSize, {"96 bytes"});
}

TEST(PointCloud, sizesThatOverflow) {
  constexpr uint32_t kMax = std::numeric_limits<uint32_t>::max();
  PointCloud2 cloud = makeCloud(kPoints, 16);
  cloud.width = 0x10000000;  // * point_step = 2^32
  expectFault(cloud, CloudFault::kDataSize, {"4294967296 bytes"});
  cloud = makeCloud(kPoints, 16);
  cloud.width = 0x08000000;
  cloud.height = 0x20;
  cloud.row_step = 0x80000000;
  expectFault(cloud, CloudFault::kDataSize, {"68719476736 bytes"});
  cloud.width = cloud.height = kMax;
  expectFault(cloud, CloudFault::kRowStep, {"correct the driver's row_step"});
}

}  // namespace
}  // namespace edgevox
