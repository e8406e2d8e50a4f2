// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "edgevox/config.hpp"
#include "edgevox/edges/density_monitor.hpp"
#include "edgevox/edges/edge_extractor.hpp"
#include "edgevox/mapping/localizer.hpp"
#include "edgevox/mapping/mapper.hpp"
#include "edgevox/scan/voxel_scan.hpp"
#include "edgevox/scan/voxelizer.hpp"
#include "edgevox/stage_timer.hpp"

namespace edgevox {

/// One cloud through the whole pipeline.
struct PipelineResult {
  ScanResult scan;
  size_t points = 0;
  size_t scan_voxels = 0;
  DroppedPoints dropped;
  std::string too_large;           ///< see VoxelScan
  std::optional<EdgeCount> edges;  ///< of the scan; none, online, if nobody has extracted them
};

/// Voxelizer, edge extractor and mapper in a row: the same calls that the nodelets make. The mapper
/// does not use the edges of a scan, which are for the counts.
class Pipeline {
 public:
  /// Throws ConfigError if the configuration is not valid.
  explicit Pipeline(const Config& config, Clock clock = Clock::kProcessCpu);

  /// From now on scans are located in `map`, which was built with the same voxel size, and not
  /// mapped; the first one is looked for near `T_map_start`, else everywhere.
  void localizeIn(MatchMap map, const std::optional<Pose>& T_map_start = std::nullopt);
  bool isLocalizing() const { return localizer_.has_value(); }

  PipelineResult process(const CloudView& cloud, const ScanPrior& prior = {});

  const Config& config() const { return config_; }
  Mapper& mapper() { return mapper_; }
  const MapBuilder& map() const { return mapper_.map(); }
  /// The density of all scans.
  const DensityMonitor& densityMonitor() const { return density_monitor_; }

 private:
  Config config_;
  Clock clock_;
  Voxelizer voxelizer_;
  EdgeExtractor extractor_;
  DensityMonitor density_monitor_;
  Mapper mapper_;
  std::optional<Localizer> localizer_;
};

}  // namespace edgevox
