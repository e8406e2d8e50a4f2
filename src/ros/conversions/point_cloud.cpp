// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversions/point_cloud.hpp"

#include <algorithm>
#include <optional>

#include "ros/conversions/field_names.hpp"
#include "ros/conversions/point_times.hpp"
#include "ros/conversions/stamp.hpp"

namespace edgevox {
namespace {

using Cloud = sensor_msgs::PointCloud2;
using Field = sensor_msgs::PointField;

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

/// Bytes of the points of a row.
uint64_t rowOf(const Cloud& cloud) { return uint64_t{cloud.width} * cloud.point_step; }

/// Without bytes between or behind the rows, whatever row_step says: drivers leave it at 0, or set
/// it to the size of all rows.
bool isPacked(const Cloud& cloud) {
  return cloud.data.size() % cloud.height == 0 && cloud.data.size() / cloud.height == rowOf(cloud);
}

uint64_t rowStepOf(const Cloud& cloud) {
  return isPacked(cloud) || cloud.height == 1 ? rowOf(cloud) : cloud.row_step;
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
  if (isPacked(cloud)) return std::nullopt;
  if (cloud.height > 1 && cloud.row_step < rowOf(cloud)) {
    return CloudError{CloudFault::kRowStep,
                      "row_step " + std::to_string(cloud.row_step) + " is less than the " +
                          std::to_string(rowOf(cloud)) + " bytes of width * point_step" +
                          where(cloud) + "correct the driver's row_step"};
  }
  const uint64_t bytes = rowStepOf(cloud) * cloud.height;
  if (bytes > cloud.data.size()) {
    return CloudError{CloudFault::kDataSize,
                      "its rows are " + std::to_string(bytes) + " bytes, the data hold " +
                          std::to_string(cloud.data.size()) + where(cloud) +
                          "the message is cut short, or its width, row_step or height is wrong"};
  }
  return std::nullopt;
}

const Field& fieldNamed(const Cloud& cloud, const char* name) {
  return *std::find_if(cloud.fields.begin(), cloud.fields.end(),
                       [&](const Field& field) { return field.name == name; });
}

CheckedCloud viewOf(const Cloud& cloud, const VoxelizerConfig& config) {
  CheckedCloud checked;
  CloudView& view = checked.view;
  view.stamp = cloud.header.stamp.toSec();
  view.frame = cloud.header.frame_id;
  view.data = cloud.data.data();
  view.width = cloud.width;
  view.height = cloud.height;
  view.point_step = cloud.point_step;
  view.row_step = rowStepOf(cloud);
  view.xyz_offset = {fieldNamed(cloud, "x").offset, fieldNamed(cloud, "y").offset,
                     fieldNamed(cloud, "z").offset};
  const bool wide = fieldNamed(cloud, "x").datatype == Field::FLOAT64;
  view.xyz_type = wide ? Scalar::kFloat64 : Scalar::kFloat32;
  PointTimes times = pointTimesOf(cloud, view, config);
  view.time = times.field;
  checked.time_field = std::move(times.name);
  checked.note = std::move(times.note);
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

CloudReading readCloud(const sensor_msgs::PointCloud2& cloud, const VoxelizerConfig& config) {
  for (const auto check : {checkStamp, checkShape, checkCoordinates, checkLayout}) {
    if (Check error = check(cloud)) return *error;
  }
  return viewOf(cloud, config);
}

}  // namespace edgevox
