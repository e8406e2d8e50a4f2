// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <sensor_msgs/PointCloud2.h>

#include <map>
#include <mutex>
#include <string>

#include "edgevox/scan/voxel_scan.hpp"
#include "edgevox/scan/voxelizer.hpp"
#include "nodes/diagnostics.hpp"
#include "ros/conversions/point_cloud.hpp"
#include "ros/live/parameters.hpp"
#include "ros/live/scan_input.hpp"
#include "ros/live/throttled_log.hpp"

namespace edgevox {

/// `points` (sensor_msgs/PointCloud2) to `voxels` (edgevox/VoxelScanStamped) and, if somebody
/// listens, `voxels_cloud`. A cloud that cannot be read is refused and counted.
class VoxelizerNode {
 public:
  /// Throws ConfigError.
  VoxelizerNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                const std::string& name);

 private:
  using Input = ScanInput<sensor_msgs::PointCloud2>;

  /// What diagnostics tell.
  struct State {
    std::map<std::string, uint64_t> refused;  // by reason
    std::string last_refusal;
    uint64_t refused_total = 0;
    uint64_t refused_told = 0;
    uint64_t dropped_told = 0;
    DroppedPoints dropped_points;
    std::string note;
    RollingTimes times;
  };

  void process(const Input::Arrival& arrival);
  void refuse(const Input::Arrival& arrival, const CloudError& error);
  void publish(const VoxelScan& scan, const Input::Arrival& arrival, const CheckedCloud& cloud,
               double seconds);
  void diagnose(DiagnosticStatus& status);

  ThrottledLog log_;
  NodeParameters parameters_;
  Voxelizer voxelizer_;
  ros::Publisher voxels_;
  ros::Publisher cloud_;
  std::mutex mutex_;  // of the state
  State state_;
  Input input_;
  NodeDiagnostics diagnostics_;
};

}  // namespace edgevox
