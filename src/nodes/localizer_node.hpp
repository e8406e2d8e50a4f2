// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <edgevox/LoadMap.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "edgevox/mapping/localizer.hpp"
#include "nodes/diagnostics.hpp"
#include "nodes/tracking_io.hpp"
#include "ros/live/map_publisher.hpp"
#include "ros/live/parameters.hpp"
#include "ros/live/throttled_log.hpp"

namespace edgevox {

/// `voxels` (or `edges`) to the pose in a saved map, which stays as it is, on TF, `odom` and
/// `path`; the map to the topics that the mapper has, too. While the sensor is looked for,
/// `candidates` tells where it may be. A service or a pose on `initialpose` ends a search that is
/// going on.
class LocalizerNode {
 public:
  /// Throws ConfigError.
  LocalizerNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                const std::string& name);

  ~LocalizerNode();

 private:
  void loadGivenMap();
  /// The localizer takes the place of that which there is at the next scan.
  void load(const MapFile& file);
  ScanReport locate(const VoxelScanStamped& scan, const ScanTransforms& transforms);
  void tellState();
  std::string takeRequests();
  void publishCandidates(const ros::Time& stamp, const ScanTransforms& transforms);
  void publishMap();
  bool loadMap(LoadMap::Request& request, LoadMap::Response& response);
  bool search(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void diagnose(DiagnosticStatus& status);

  ThrottledLog log_;
  LocalizerParameters parameters_;
  ros::Publisher candidates_;
  std::mutex publishing_;  // of the map
  MapPublisher map_publisher_;
  std::atomic<bool> looking_{false};
  std::atomic<bool> comparing_{false};
  std::atomic<size_t> candidate_count_{0};
  std::atomic<int> percent_{0};           // of the search
  std::unique_ptr<Localizer> localizer_;  // of the thread of the scans

  std::mutex mutex_;                   // of all below, up to the input and output
  std::unique_ptr<Localizer> loaded_;  // not taken yet
  bool look_everywhere_ = false;
  std::shared_ptr<const MatchMap> map_;
  std::string map_error_ = "no map is loaded";
  uint64_t map_version_ = 0;

  TrackingIo io_;
  ros::WallTimer map_timer_;
  NodeDiagnostics diagnostics_;
};

}  // namespace edgevox
