// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/mapping/pipeline.hpp"

#include <utility>

namespace edgevox {
namespace {

const Config& checked(const Config& config) {
  validate(config);
  return config;
}

}  // namespace

Pipeline::Pipeline(const Config& config, Clock clock)
    : config_(config),
      clock_(clock),
      voxelizer_(checked(config).voxelizer, config.voxel_size),
      extractor_(config.edges, config.threads),
      density_monitor_(config.edges, config.threads, DensityMonitor::kEveryScan),
      mapper_(config, clock) {}

void Pipeline::localizeIn(MatchMap map, const std::optional<Pose>& T_map_start) {
  localizer_.emplace(config_, std::move(map), clock_);
  if (T_map_start) localizer_->lookNear(*T_map_start);
}

PipelineResult Pipeline::process(const CloudView& cloud, const ScanPrior& prior) {
  StageTimer timer(clock_);
  PipelineResult result;
  VoxelScan scan = voxelizer_.voxelize(cloud);
  const double voxelize = timer.lap();
  result.edges = extractor_.extract(scan);
  density_monitor_.add(scan, *result.edges);
  const double extract = timer.lap();
  result.scan_voxels = scan.voxels.size();
  scan = voxelsToMatch(std::move(scan), config_.mapper.scan_voxels);
  result.scan = localizer_ ? localizer_->process(scan, prior) : mapper_.process(scan, prior);
  result.scan.times.voxelize = static_cast<float>(voxelize);
  result.scan.times.extract = static_cast<float>(extract);
  result.points = scan.points_read;
  result.dropped = scan.dropped;
  result.too_large = scan.too_large;
  return result;
}

}  // namespace edgevox
