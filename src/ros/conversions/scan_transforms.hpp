// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <std_msgs/Header.h>

#include <optional>
#include <string>
#include <variant>

#include "edgevox/mapping/mapper.hpp"
#include "ros/conversions/scan_refusal.hpp"
#include "ros/conversions/sensor_frames.hpp"

namespace edgevox {

/// What TF says about one scan.
struct ScanTransforms {
  Pose T_base_sensor = Pose::Identity();
  std::optional<Pose> T_odom_sensor;
  std::string odometry_error;  ///< why there is no T_odom_sensor though odometry is used

  /// The map frame is the odometry's, else the base's, at the first scan.
  ScanPrior prior() const { return {T_odom_sensor, T_odom_sensor.value_or(T_base_sensor)}; }
};

/// Decides by its header whether a scan can be mapped, in the same way online and offline: its
/// frame must be that of the first scan and its mounting must be known. Without odometry, where it
/// is used, a scan is mapped at constant velocity.
class ScanTransformer {
 public:
  /// The buffer of `frames` must outlive this.
  explicit ScanTransformer(const SensorFrames& frames) : frames_(frames) {}

  std::variant<ScanTransforms, ScanRefusal> transformsOf(const std_msgs::Header& header);
  /// Whether TF holds all that transformsOf() looks up.
  bool isReady(const std_msgs::Header& header) const;
  /// The next scan is the first.
  void reset() { sensor_frame_.reset(); }

 private:
  SensorFrames frames_;
  std::optional<std::string> sensor_frame_;  // of all scans
};

}  // namespace edgevox
