// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversions/voxel_scan_message.hpp"

#include <algorithm>
#include <cmath>

#include "edgevox/scan/voxelizer.hpp"

#include "ros/conversions/stamp.hpp"

namespace edgevox {
namespace {

constexpr float kLongestSweep = 2.0F;  // [s]

Voxel toMessage(const ScanVoxel& voxel) {
  Voxel message;
  message.x = voxel.index.x;
  message.y = voxel.index.y;
  message.z = voxel.index.z;
  message.centroid.x = voxel.centroid.x();
  message.centroid.y = voxel.centroid.y();
  message.centroid.z = voxel.centroid.z();
  message.time_offset = voxel.time_offset;
  message.point_count = voxel.point_count;
  message.edge = static_cast<uint8_t>(voxel.edge);
  return message;
}

ScanVoxel fromMessage(const Voxel& message) {
  ScanVoxel voxel;
  voxel.index = {message.x, message.y, message.z};
  voxel.centroid = {message.centroid.x, message.centroid.y, message.centroid.z};
  voxel.time_offset = message.time_offset;
  voxel.point_count = message.point_count;
  voxel.edge = message.edge != 0;
  return voxel;
}

bool isPossible(const ScanVoxel& voxel, double voxel_size) {
  const float farthest = static_cast<float>(kIndexLimit * voxel_size);
  return inGridRange(voxel.index) && voxel.point_count > 0 &&
         voxel.centroid.cwiseAbs().maxCoeff() <= farthest && voxel.centroid.allFinite() &&
         std::abs(voxel.time_offset) <= kLongestSweep;
}

bool changesResults(const std::string& name) {
  return name != "threads" && name != "edges/instruction_set";
}

std::string differenceText(const std::string& name, const std::string& theirs,
                           const std::string& ours) {
  return "its parameter '" + name + "' is " + theirs + ", here it is " + ours +
         "; give all nodelets the same configuration and start them again";
}

/// The first setting that differs, in words that say what to do.
std::optional<std::string> mismatchOf(const VoxelScanStamped& message, Config config) {
  const std::vector<Parameter> ours = parametersOf(config);
  for (const Setting& setting : message.settings) {
    const auto found = std::find_if(ours.begin(), ours.end(), [&](const Parameter& parameter) {
      return parameter.name == setting.name;
    });
    if (found == ours.end()) {
      return "it has a parameter '" + setting.name +
             "', which is not known here; use one version of edgevox on all computers";
    }
    if (!changesResults(setting.name)) continue;
    const std::string text = valueText(*found);
    if (text != setting.value) return differenceText(setting.name, setting.value, text);
  }
  if (message.voxel_size == config.voxel_size / 2) return std::nullopt;
  return differenceText("voxel_size", std::to_string(2 * message.voxel_size),
                        std::to_string(config.voxel_size));
}

}  // namespace

bool isPossible(const Voxel& voxel, double voxel_size) {
  return isPossible(fromMessage(voxel), voxel_size);
}

VoxelScanStamped toMessage(const VoxelScan& scan, const std_msgs::Header& header) {
  VoxelScanStamped message;
  message.header = header;
  message.number = scan.number;
  message.voxel_size = scan.voxel_size;
  message.voxels.reserve(scan.voxels.size());
  for (const ScanVoxel& voxel : scan.voxels) message.voxels.push_back(toMessage(voxel));
  message.points_read = scan.points_read;
  message.points_not_finite = scan.dropped.not_finite;
  message.points_too_near = scan.dropped.too_near;
  message.points_too_far = scan.dropped.too_far;
  message.points_bad_time = scan.dropped.bad_time;
  return message;
}

VoxelScan fromMessage(const VoxelScanStamped& message) {
  VoxelScan scan;
  scan.stamp = message.header.stamp.toSec();
  scan.frame = message.header.frame_id;
  scan.number = message.number;
  scan.voxel_size = message.voxel_size;
  scan.voxels.reserve(message.voxels.size());
  for (const Voxel& voxel : message.voxels) {
    const ScanVoxel read = fromMessage(voxel);
    if (isPossible(read, message.voxel_size)) scan.voxels.push_back(read);
  }
  scan.points_read = message.points_read;
  scan.dropped = {message.points_not_finite, message.points_too_near, message.points_too_far,
                  message.points_bad_time};
  return scan;
}

void addSettings(Config config, const std::vector<std::string>& prefixes,
                 VoxelScanStamped& message) {
  for (const Parameter& parameter : parametersOf(config)) {
    const std::string& name = parameter.name;
    const bool wanted = std::any_of(prefixes.begin(), prefixes.end(), [&](const auto& prefix) {
      return name.compare(0, prefix.size(), prefix) == 0;
    });
    if (!wanted || !changesResults(name)) continue;
    Setting setting;
    setting.name = name;
    setting.value = valueText(parameter);
    message.settings.push_back(setting);
  }
}

std::optional<ScanRefusal> refusalOf(const VoxelScanStamped& message, const Config& config) {
  if (const auto fault = faultOf(message.header.stamp)) {
    return ScanRefusal{"bad_stamp", *fault + "; correct the clock of whatever sends the scans"};
  }
  if (const auto mismatch = mismatchOf(message, config)) {
    return ScanRefusal{"config_mismatch", *mismatch};
  }
  if (message.voxels.size() > static_cast<size_t>(config.voxelizer.max_voxels)) {
    return ScanRefusal{"too_large", tooManyVoxelsText(config.voxelizer)};
  }
  return std::nullopt;
}

}  // namespace edgevox
