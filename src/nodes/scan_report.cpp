// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/scan_report.hpp"

#include "ros/conversions/stamp.hpp"
#include "run/scan_advice.hpp"

namespace edgevox {
namespace {

ScanReport reportOn(const VoxelScanStamped& scan) {
  ScanReport report;
  report.header = scan.header;
  report.number = scan.number;
  report.points = static_cast<uint32_t>(scan.points_read);
  report.voxels = static_cast<uint32_t>(scan.voxels.size());
  report.edge_voxels = scan.edge_voxels;
  report.voxelize = scan.voxelize_seconds;
  report.extract = scan.extract_seconds;
  report.refused = scan.refused;
  report.dropped = scan.dropped;
  return report;
}

}  // namespace

StageTimes timesOf(const ScanReport& report) {
  return {report.voxelize, report.extract, report.match, report.insert, report.label};
}

PipelineResult toPipelineResult(const VoxelScanStamped& scan, const ScanResult& result) {
  PipelineResult all;
  all.scan = result;
  all.points = scan.points_read;
  all.scan_voxels = scan.voxels.size();
  all.dropped = {scan.points_not_finite, scan.points_too_near, scan.points_too_far,
                 scan.points_bad_time};
  all.scan.times.voxelize = scan.voxelize_seconds;
  if (scan.occupied_voxels == 0) return all;  // it has not been by the edge extractor
  all.edges = {scan.occupied_voxels, scan.edge_voxels, scan.sparse_voxels};
  all.scan.times.extract = scan.extract_seconds;
  return all;
}

ScanReport reportOn(const VoxelScanStamped& scan, const ScanResult& result,
                    const std::string& way_out) {
  ScanReport report = reportOn(scan);
  report.located = static_cast<uint8_t>(result.located());
  report.status = toString(result.status);
  report.text = adviceOn(result, way_out);
  report.hit_ratio = static_cast<float>(result.hit_ratio);
  report.hit_share = static_cast<float>(result.hit_share);
  report.required_hit_ratio = static_cast<float>(result.required_hit_ratio);
  report.blocked = static_cast<float>(result.blocked);
  report.most_blocked = static_cast<float>(result.most_blocked);
  report.matches = result.matches;
  report.degenerate = static_cast<uint8_t>(result.degeneracy.directions);
  for (size_t i = 0; i < report.weakest.size(); ++i) {
    report.weakest[i] = static_cast<float>(result.degeneracy.weakest[static_cast<int>(i)]);
  }
  report.restarts = result.restarts;
  report.odometry_jumped = static_cast<uint8_t>(result.odometry_jumped);
  report.begun_anew = static_cast<uint8_t>(result.begun_anew);
  report.match = result.times.match;
  report.insert = result.times.insert;
  report.label = result.times.label;
  return report;
}

ScanReport reportOn(const VoxelScanStamped& scan, const ScanRefusal& refusal) {
  ScanReport report = reportOn(scan);
  if (faultOf(scan.header.stamp)) report.header.stamp = ros::Time();
  report.status = refusal.reason;
  report.text = refusal.text;
  return report;
}

}  // namespace edgevox
