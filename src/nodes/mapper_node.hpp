// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <edgevox/SaveMap.h>
#include <edgevox/VoxelScanStamped.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <std_srvs/Trigger.h>

#include <mutex>
#include <string>

#include "edgevox/mapping/mapper.hpp"
#include "edgevox/tracking/clock_watch.hpp"
#include "nodes/diagnostics.hpp"
#include "nodes/mapper_status.hpp"
#include "nodes/scan_report.hpp"
#include "ros/conversions/scan_transforms.hpp"
#include "ros/live/map_publisher.hpp"
#include "ros/live/map_transform.hpp"
#include "ros/live/parameters.hpp"
#include "ros/live/pose_publisher.hpp"
#include "ros/live/scan_input.hpp"
#include "ros/live/service_offers.hpp"
#include "ros/live/throttled_log.hpp"
#include "ros/live/transform_input.hpp"
#include "run/run_record.hpp"

namespace edgevox {

/// `voxels` (or `edges`) to the pose on TF, `odom` and `path`, to the map on `map_edges`,
/// `map_boxes`, `map_boxes_update` and `map_occupied`, and to the edges of the last scan by those
/// before it on `scan_edges`. `scan_report` tells what became of every scan. A scan waits for no
/// publishing, saving or diagnosing but while a snapshot of the map is taken.
class MapperNode {
 public:
  /// Throws ConfigError.
  MapperNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
             const std::string& name);

 private:
  using Input = ScanInput<VoxelScanStamped>;

  void process(const Input::Arrival& arrival);
  void watchClock(double stamp);
  void waitForTransforms(const Input::Arrival& arrival) const;
  ScanReport map(const VoxelScanStamped& scan, const ScanTransforms& transforms);
  void clockJumped();
  void begunAnew(uint64_t scan);
  void publishPose(const VoxelScanStamped& scan, const ScanResult& result,
                   const ScanTransforms& transforms);
  void publishScanEdges(const ros::Time& stamp) const;
  void report(ScanReport report);
  void publishMap();
  bool saveMap(SaveMap::Request& request, SaveMap::Response& response);
  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void diagnose(DiagnosticStatus& status);

  ThrottledLog log_;
  MapperParameters parameters_;
  TransformInput transforms_;
  ClockWatch clock_watch_;
  ros::Publisher reports_;
  ros::Publisher scan_edges_;
  std::mutex publishing_;  // of the map
  MapPublisher map_publisher_;

  std::mutex mutex_;  // of all below, up to the input
  ScanTransformer transformer_;
  MapTransform map_transform_;
  PosePublisher pose_publisher_;
  Mapper mapper_;
  RunRecord run_;
  MapperStatus status_;
  uint64_t map_version_ = 0;
  uint64_t map_start_ = 0;        // differs after a reset, a jump of the clock or a new begin
  uint64_t transforms_told_ = 0;  // as refused
  ros::Time last_stamp_;          // of the last located scan

  Input input_;
  ros::WallTimer map_timer_;
  ServiceOffers services_;
  NodeDiagnostics diagnostics_;
};

}  // namespace edgevox
