// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <edgevox/VoxelScanStamped.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "edgevox/edges/density_monitor.hpp"
#include "edgevox/edges/edge_extractor.hpp"
#include "edgevox/scan/voxel_scan.hpp"
#include "nodes/diagnostics.hpp"
#include "ros/conversions/scan_refusal.hpp"
#include "ros/live/parameters.hpp"
#include "ros/live/scan_input.hpp"
#include "ros/live/throttled_log.hpp"

namespace edgevox {

/// `voxels` to `edges`, the same with the edge voxels marked, and `edges_cloud`, for display and
/// for whoever else listens; watches whether the points are dense enough for the voxels. Scans with
/// a bad stamp or made with another configuration are refused.
class EdgeExtractorNode {
 public:
  /// Throws ConfigError.
  EdgeExtractorNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                    const std::string& name);

 private:
  using Input = ScanInput<VoxelScanStamped>;

  /// What diagnostics tell.
  struct State {
    std::optional<ScanRefusal> refusal;       // of the last scan
    std::map<std::string, uint64_t> refused;  // by reason
    uint64_t dropped_told = 0;
    EdgeCount last;
    RollingTimes times;
  };

  void process(const Input::Arrival& arrival);
  void note(const std::optional<ScanRefusal>& refusal);
  void watchSparsity(const VoxelScan& scan, const EdgeCount& count);
  void diagnose(DiagnosticStatus& status);

  ThrottledLog log_;
  NodeParameters parameters_;
  EdgeExtractor extractor_;
  ros::Publisher edges_;
  ros::Publisher cloud_;
  std::mutex mutex_;  // of the state and the alarm
  State state_;
  DensityMonitor density_monitor_;
  Input input_;
  NodeDiagnostics diagnostics_;
};

}  // namespace edgevox
