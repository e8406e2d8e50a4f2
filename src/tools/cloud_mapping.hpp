// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "edgevox/pipeline.hpp"
#include "edgevox/trajectory_io.hpp"
#include "ros/point_cloud.hpp"
#include "ros/sensor_frames.hpp"
#include "tools/console.hpp"

namespace edgevox {

/// One cloud that went through the pipeline.
struct ScanRecord {
  size_t cloud = 0;  ///< in the bag, from 0
  PipelineResult result;
  double total = 0.0;                  ///< CPU time of the whole pipeline [s]
  Pose T_map_body = Pose::Identity();  ///< of the base frame, or of the sensor without one
};

/// Maps the clouds of one sensor and keeps account of them. The map frame is the sensor's frame at
/// its first scan. A cloud that cannot be read, that is in another frame than the first scan, or
/// whose mounting is not known, is left out.
class CloudMapping {
 public:
  /// `frames` and `console` must outlive this. Throws ConfigError.
  CloudMapping(const Config& config, const SensorFrames& frames, Console& console);

  /// Null stands for a message that cannot be decoded.
  void add(size_t cloud, const sensor_msgs::PointCloud2::ConstPtr& message);
  /// Brings the map's labels up to date; no clouds after that.
  void finish() { pipeline_.mapper().finishLabels(); }

  const std::vector<ScanRecord>& scans() const { return scans_; }
  const OccupiedVoxelMap& map() const { return pipeline_.map(); }
  Trajectory trajectory() const;  ///< of the located scans
  const std::map<std::string, size_t>& cloudsLeftOut() const { return left_out_; }  ///< by reason
  size_t scansWithoutOdometry() const { return without_odometry_; }
  const std::string& timeField() const { return time_field_; }

 private:
  void leaveOut(size_t cloud, const std::string& reason, const std::string& text);
  void process(size_t cloud, const sensor_msgs::PointCloud2& message, const CheckedCloud& checked);
  std::optional<Pose> odometryOf(size_t cloud, const std_msgs::Header& header);
  void printNote(const std::string& note);

  SensorFrames frames_;
  Console& console_;
  Pipeline pipeline_;
  std::vector<ScanRecord> scans_;
  std::map<std::string, size_t> left_out_;
  size_t without_odometry_ = 0;
  std::string frame_;  // of all scans
  std::string time_field_;
  std::string printed_note_;
};

}  // namespace edgevox
