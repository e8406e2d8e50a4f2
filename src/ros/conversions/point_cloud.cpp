// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversions/point_cloud.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <optional>

#include "ros/conversions/stamp.hpp"

namespace edgevox {
namespace {

using Cloud = sensor_msgs::PointCloud2;
using Field = sensor_msgs::PointField;

// Float64 times are told apart by their size: 1e8 s after the epoch is 1973, 1e17 ns as well.
constexpr double kLeastEpochSeconds = 1e8;
constexpr double kLeastEpochNanoseconds = 1e17;

size_t sizeOf(uint8_t datatype) {
  switch (datatype) {
    case Field::INT8:
    case Field::UINT8:
      return 1;
    case Field::INT16:
    case Field::UINT16:
      return 2;
    case Field::INT32:
    case Field::UINT32:
    case Field::FLOAT32:
      return 4;
    case Field::FLOAT64:
      return 8;
    default:
      return 0;
  }
}

std::string typeName(uint8_t datatype) {
  constexpr std::array<const char*, 9> kNames = {"none",  "int8",   "uint8",   "int16",  "uint16",
                                                 "int32", "uint32", "float32", "float64"};
  return datatype < kNames.size() ? kNames[datatype] : "unknown type " + std::to_string(datatype);
}

std::string fieldNames(const Cloud& cloud) {
  std::string names;
  for (const Field& field : cloud.fields) names += (names.empty() ? "" : ", ") + field.name;
  return names.empty() ? "none" : names;
}

/// The end of a message that says what is wrong.
std::string where(const Cloud& cloud) {
  return " (cloud of " + std::to_string(cloud.width) + " x " + std::to_string(cloud.height) +
         " points, frame '" + cloud.header.frame_id + "'); ";
}

using Check = std::optional<CloudError>;

Check checkStamp(const Cloud& cloud) {
  const auto fault = faultOf(cloud.header.stamp);
  if (!fault) return std::nullopt;
  return CloudError{CloudFault::kStamp, *fault + where(cloud) + "correct the driver's clock"};
}

Check checkShape(const Cloud& cloud) {
  if (cloud.width == 0 || cloud.height == 0) {
    return CloudError{CloudFault::kEmpty, "the cloud has no points" + where(cloud) +
                                              "check the driver's range and filter settings"};
  }
  if (cloud.is_bigendian) {
    return CloudError{CloudFault::kBigEndian, "the data are big-endian" + where(cloud) +
                                                  "publish them in little-endian order"};
  }
  return std::nullopt;
}

Check checkCoordinate(const Cloud& cloud, const std::string& axis) {
  const auto is_axis = [&](const Field& field) { return field.name == axis; };
  const auto count = std::count_if(cloud.fields.begin(), cloud.fields.end(), is_axis);
  if (count == 0) {
    return CloudError{CloudFault::kMissingCoordinate,
                      "there is no field '" + axis + "'" + where(cloud) + "its fields are: " +
                          fieldNames(cloud) + "; choose a topic whose clouds have x, y and z"};
  }
  if (count > 1) {
    return CloudError{CloudFault::kDuplicateCoordinate,
                      "field '" + axis + "' is there " + std::to_string(count) + " times" +
                          where(cloud) + "a name must be unique; correct the driver"};
  }
  const auto field = std::find_if(cloud.fields.begin(), cloud.fields.end(), is_axis);
  if (field->datatype != Field::FLOAT32 && field->datatype != Field::FLOAT64) {
    return CloudError{CloudFault::kCoordinateType,
                      "field '" + axis + "' is " + typeName(field->datatype) + where(cloud) +
                          "x, y and z must be float32 or float64, in metres"};
  }
  return std::nullopt;
}

Check checkCoordinates(const Cloud& cloud) {
  for (const char* axis : {"x", "y", "z"}) {
    if (Check error = checkCoordinate(cloud, axis)) return error;
  }
  std::string types;
  for (const Field& field : cloud.fields) {
    if (field.name != "x" && field.name != "y" && field.name != "z") continue;
    const std::string type = typeName(field.datatype);
    if (!types.empty() && types != type) {
      return CloudError{CloudFault::kCoordinateType, "x, y and z are of different types, " + types +
                                                         " and " + type + where(cloud) +
                                                         "give them one type"};
    }
    types = type;
  }
  return std::nullopt;
}

bool insidePoint(const Field& field, const Cloud& cloud) {
  return uint64_t{field.offset} + sizeOf(field.datatype) <= cloud.point_step;
}

Check checkLayout(const Cloud& cloud) {
  for (const Field& field : cloud.fields) {
    if (insidePoint(field, cloud)) continue;
    return CloudError{CloudFault::kPointStep,
                      "field '" + field.name + "' (" + typeName(field.datatype) + " at byte " +
                          std::to_string(field.offset) + ") does not fit in point_step " +
                          std::to_string(cloud.point_step) + where(cloud) +
                          "correct the driver's offsets or point_step"};
  }
  const uint64_t row = uint64_t{cloud.width} * cloud.point_step;
  if (cloud.row_step < row) {
    return CloudError{CloudFault::kRowStep, "row_step " + std::to_string(cloud.row_step) +
                                                " is less than the " + std::to_string(row) +
                                                " bytes of width * point_step" + where(cloud) +
                                                "correct the driver's row_step"};
  }
  const uint64_t bytes = uint64_t{cloud.row_step} * cloud.height;
  if (bytes > cloud.data.size()) {
    return CloudError{CloudFault::kDataSize,
                      "row_step * height is " + std::to_string(bytes) + " bytes, the data hold " +
                          std::to_string(cloud.data.size()) + where(cloud) +
                          "the message is cut short or its row_step or height is wrong"};
  }
  return std::nullopt;
}

const Field& fieldNamed(const Cloud& cloud, const char* name) {
  return *std::find_if(cloud.fields.begin(), cloud.fields.end(),
                       [&](const Field& field) { return field.name == name; });
}

std::string lowerWithoutUnderscores(const std::string& name) {
  std::string plain;
  for (const char c : name) {
    if (c != '_') plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return plain;
}

bool isTimeName(const std::string& name) {
  constexpr std::array<const char*, 5> kNames = {"time", "t", "timestamp", "offsettime",
                                                 "timeoffset"};
  return std::find(kNames.begin(), kNames.end(), lowerWithoutUnderscores(name)) != kNames.end();
}

/// The first time that is finite and not 0; points without a return often have 0.
double typicalTime(const Cloud& cloud, size_t offset) {
  for (size_t row = 0; row < cloud.height; ++row) {
    const uint8_t* at = cloud.data.data() + row * cloud.row_step + offset;
    for (size_t i = 0; i < cloud.width; ++i, at += cloud.point_step) {
      double time;
      std::memcpy(&time, at, sizeof(time));
      if (std::isfinite(time) && time != 0.0) return time;
    }
  }
  return 0.0;
}

std::optional<TimeField> timeFieldOf(const Cloud& cloud, const Field& field) {
  TimeField time;
  time.present = true;
  time.offset = field.offset;
  switch (field.datatype) {
    case Field::FLOAT32:
      time.type = Scalar::kFloat32;
      return time;
    case Field::UINT32:
      time.type = Scalar::kUint32;
      time.unit = 1e-9;
      return time;
    case Field::FLOAT64: {
      const double typical = std::abs(typicalTime(cloud, field.offset));
      time.type = Scalar::kFloat64;
      time.unit = typical >= kLeastEpochNanoseconds ? 1e-9 : 1.0;
      time.absolute = typical >= kLeastEpochSeconds;
      return time;
    }
    default:
      return std::nullopt;
  }
}

void setTime(const Cloud& cloud, CheckedCloud& checked) {
  for (const Field& field : cloud.fields) {
    if (!isTimeName(field.name)) continue;
    if (const auto time = timeFieldOf(cloud, field)) {
      checked.view.time = *time;
      checked.time_field = field.name;
      checked.note.clear();
      return;
    }
    checked.note = "the points' times are not used: field '" + field.name + "' is " +
                   typeName(field.datatype) +
                   "; known are float32 [s], uint32 [ns] and float64 [s or ns]";
  }
}

CheckedCloud viewOf(const Cloud& cloud) {
  CheckedCloud checked;
  CloudView& view = checked.view;
  view.stamp = cloud.header.stamp.toSec();
  view.frame = cloud.header.frame_id;
  view.data = cloud.data.data();
  view.width = cloud.width;
  view.height = cloud.height;
  view.point_step = cloud.point_step;
  view.row_step = cloud.row_step;
  view.xyz_offset = {fieldNamed(cloud, "x").offset, fieldNamed(cloud, "y").offset,
                     fieldNamed(cloud, "z").offset};
  const bool wide = fieldNamed(cloud, "x").datatype == Field::FLOAT64;
  view.xyz_type = wide ? Scalar::kFloat64 : Scalar::kFloat32;
  setTime(cloud, checked);
  return checked;
}

}  // namespace

const char* toString(CloudFault fault) {
  switch (fault) {
    case CloudFault::kStamp:
      return "bad_stamp";
    case CloudFault::kEmpty:
      return "empty";
    case CloudFault::kBigEndian:
      return "big_endian";
    case CloudFault::kMissingCoordinate:
      return "missing_coordinate";
    case CloudFault::kDuplicateCoordinate:
      return "duplicate_coordinate";
    case CloudFault::kCoordinateType:
      return "coordinate_type";
    case CloudFault::kPointStep:
      return "point_step";
    case CloudFault::kRowStep:
      return "row_step";
    case CloudFault::kDataSize:
      return "data_size";
    case CloudFault::kTooLarge:
      return "too_large";
  }
  return "";
}

CloudReading readCloud(const sensor_msgs::PointCloud2& cloud) {
  for (const auto check : {checkStamp, checkShape, checkCoordinates, checkLayout}) {
    if (Check error = check(cloud)) return *error;
  }
  return viewOf(cloud);
}

}  // namespace edgevox
