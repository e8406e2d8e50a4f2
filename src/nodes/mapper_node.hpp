// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <edgevox/LoadMap.h>
#include <edgevox/SaveMap.h>
#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>

#include <mutex>
#include <string>

#include "edgevox/mapping/mapper.hpp"
#include "nodes/diagnostics.hpp"
#include "nodes/tracking_io.hpp"
#include "ros/live/map_publisher.hpp"
#include "ros/live/parameters.hpp"
#include "ros/live/throttled_log.hpp"
#include "run/run_record.hpp"

namespace edgevox {

/// `voxels` (or `edges`) to the pose on TF, `odom` and `path`, to the map on `map_edges`,
/// `map_boxes`, `map_boxes_update` and `map_occupied`, and to the edges of the last scan by those
/// before it on `scan_edges`. `scan_report` tells what became of every scan. A scan waits for no
/// publishing, saving or diagnosing but while a snapshot of the map is taken. At its end it saves
/// to `output` what was not saved.
class MapperNode {
 public:
  /// Throws ConfigError.
  MapperNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
             const std::string& name);

  ~MapperNode();

 private:
  void loadGivenMap();
  Mapper newMapper() const;
  void put(Mapper mapper);
  ScanReport map(const VoxelScanStamped& scan, const ScanTransforms& transforms);
  void clockJumped();
  void begunAnew(uint64_t scan);
  void publishMap();
  void saveAtTheEnd();
  RunRecord record() const;
  bool saveMap(SaveMap::Request& request, SaveMap::Response& response);
  bool loadMap(LoadMap::Request& request, LoadMap::Response& response);
  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void diagnose(DiagnosticStatus& status);

  ThrottledLog log_;
  MapperParameters parameters_;
  std::mutex publishing_;  // of the map
  MapPublisher map_publisher_;

  std::mutex mutex_;  // of all below, up to the input and output
  Mapper mapper_;
  RunRecord run_;
  std::string map_error_;  // why there is no map to go on with, where there should be one
  uint64_t map_version_ = 0;
  uint64_t saved_version_ = 0;
  uint64_t map_start_ = 0;  // differs after a reset, a jump of the clock or a new begin

  TrackingIo io_;
  ros::WallTimer map_timer_;
  NodeDiagnostics diagnostics_;
};

}  // namespace edgevox
