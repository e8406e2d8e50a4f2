// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversions/point_times.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "ros/conversions/field_names.hpp"

namespace edgevox {
namespace {

using Cloud = sensor_msgs::PointCloud2;
using Field = sensor_msgs::PointField;

constexpr size_t kLooked = 4000;         // points, about
constexpr double kShortestSweep = 2e-3;  // [s]
constexpr double kLongestSweep = kLongestTimeOffset;
constexpr double kShortestPart = 3e-4;  // of a sweep, as a packet [s]
constexpr double kMostWrong = 0.05;     // of the times
constexpr double kMostAside = 0.25;     // of the times
constexpr double kFarther = 0.3;        // of the whole interval, that most are in if some are aside
constexpr std::array<double, 4> kUnits = {1.0, 1e-3, 1e-6, 1e-9};

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

std::optional<Scalar> scalarOf(const Field& field) {
  switch (field.datatype) {
    case Field::FLOAT32:
      return Scalar::kFloat32;
    case Field::FLOAT64:
      return Scalar::kFloat64;
    case Field::UINT32:
      return Scalar::kUint32;
    default:
      return std::nullopt;
  }
}

template <typename T>
double valueAt(const uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return static_cast<double>(value);
}

double valueAt(const uint8_t* at, Scalar type) {
  switch (type) {
    case Scalar::kFloat32:
      return valueAt<float>(at);
    case Scalar::kFloat64:
      return valueAt<double>(at);
    case Scalar::kUint32:
      return valueAt<uint32_t>(at);
  }
  return 0.0;
}

/// 0 or NaN of what has no return.
double squaredRange(const uint8_t* point, const CloudView& view) {
  double sum = 0.0;
  for (const size_t offset : view.xyz_offset) {
    const double coordinate = valueAt(point + offset, view.xyz_type);
    sum += coordinate * coordinate;
  }
  return sum;
}

/// Of points spread over the cloud, the first and the last among them, those that have a return.
std::vector<double> someTimes(const CloudView& view, const TimeField& field) {
  const size_t count = view.width * view.height;
  const size_t looked = std::min(count, kLooked);
  std::vector<double> times;
  for (size_t i = 0; i < looked; ++i) {
    const size_t number = looked == 1 ? 0 : i * (count - 1) / (looked - 1);
    const uint8_t* point =
        view.data + number / view.width * view.row_step + number % view.width * view.point_step;
    const double range = squaredRange(point, view);
    if (std::isfinite(range) && range > 0.0) {
      times.push_back(valueAt(point + field.offset, field.type));
    }
  }
  return times;
}

/// From the first to the last of the times in a cloud, in their own unit.
struct Interval {
  double first = 0.0;
  double last = 0.0;

  double length() const { return last - first; }
};

/// Of finite times, at least one. Those that are far from most are left out.
Interval intervalOf(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  const Interval all{times.front(), times.back()};
  const auto few = static_cast<size_t>(kMostAside * static_cast<double>(times.size()));
  Interval most = all;
  for (size_t left_out = 0; left_out <= few; ++left_out) {
    const Interval part{times[left_out], times[times.size() - 1 - (few - left_out)]};
    if (part.length() < most.length()) most = part;
  }
  const double length = most.length();
  if (length > kFarther * all.length()) return all;
  return {*std::lower_bound(times.begin(), times.end(), most.first - length),
          *std::prev(std::upper_bound(times.begin(), times.end(), most.last + length))};
}

double usualUnit(Scalar type, double typical) {
  if (type == Scalar::kUint32) return 1e-9;
  if (type == Scalar::kFloat32) return 1.0;
  // After 1973, counted in each unit.
  const double since_epoch = std::abs(typical);
  if (since_epoch >= 1e17) return 1e-9;
  if (since_epoch >= 1e14) return 1e-6;
  return since_epoch >= 1e11 ? 1e-3 : 1.0;
}

double unitOf(TimeUnit given, Scalar type, const Interval& times) {
  if (given != TimeUnit::kAuto) return kUnits[static_cast<size_t>(given) - 1];
  const double usual = usualUnit(type, times.last);
  const double seconds = times.length() * usual;
  if (times.length() == 0 || (seconds >= kShortestPart && seconds <= kLongestSweep)) return usual;
  for (const double unit : kUnits) {
    const double length = times.length() * unit;
    if (length > kShortestSweep && length <= kLongestSweep) return unit;
  }
  return usual;
}

struct Origin {
  double value = 0.0;  ///< in the unit of the times
  bool other_clock = false;
};

Origin originOf(StampAt given, const Interval& times, double unit, double stamp) {
  if (given == StampAt::kFirst) return {times.first, false};
  if (given == StampAt::kLast) return {times.last, false};
  const auto isNear = [&](double origin) {
    return std::abs((times.first - origin) * unit) <= kLongestSweep &&
           std::abs((times.last - origin) * unit) <= kLongestSweep;
  };
  if (isNear(0.0)) return {};
  if (isNear(stamp / unit)) return {stamp / unit, false};
  return {times.first, true};
}

bool isGood(double time, const TimeField& field) {
  return std::abs((time - field.start) * field.unit) <= kLongestSweep;  // NaN is not
}

PointTimes timesIn(const Field& field, Scalar type, const CloudView& view,
                   const VoxelizerConfig& config) {
  PointTimes found;
  found.field.offset = field.offset;
  found.field.type = type;
  const std::string which =
      "the points' times (field '" + field.name + "', " + typeName(field.datatype) + ") ";
  const std::vector<double> times = someTimes(view, found.field);
  std::vector<double> finite;
  std::copy_if(times.begin(), times.end(), std::back_inserter(finite),
               [](double time) { return std::isfinite(time); });
  bool other_clock = false;
  if (!finite.empty()) {
    const Interval interval = intervalOf(std::move(finite));
    found.field.unit = unitOf(config.time_unit, type, interval);
    const Origin origin = originOf(config.stamp_at, interval, found.field.unit, view.stamp);
    found.field.start = origin.value;
    other_clock = origin.other_clock;
  }
  const auto wrong = std::count_if(times.begin(), times.end(),
                                   [&](double time) { return !isGood(time, found.field); });
  if (static_cast<double>(wrong) > kMostWrong * static_cast<double>(times.size())) {
    found.note = which +
                 "are not used: more than one in twenty is not within 2 s of the stamp; set "
                 "voxelizer/time_unit, or correct the driver";
    return found;
  }
  found.field.present = true;
  found.name = field.name;
  if (other_clock) {
    found.note = which +
                 "are of another clock than the cloud's stamp and are counted from its first "
                 "point; synchronise the clocks, or set voxelizer/stamp_at";
  }
  return found;
}

}  // namespace

PointTimes pointTimesOf(const Cloud& cloud, const CloudView& view, const VoxelizerConfig& config) {
  PointTimes times;
  if (config.time_unit == TimeUnit::kNone) return times;
  for (const Field& field : cloud.fields) {
    if (!isTimeName(field.name)) continue;
    if (const auto type = scalarOf(field)) return timesIn(field, *type, view, config);
    times.note = "the points' times are not used: field '" + field.name + "' is " +
                 typeName(field.datatype) + "; known are float32, float64 and uint32";
  }
  return times;
}

}  // namespace edgevox
