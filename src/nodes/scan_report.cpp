// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/scan_report.hpp"

#include <cmath>

#include "ros/conversions/stamp.hpp"

namespace edgevox {
namespace {

std::string percent(double ratio) {
  return std::to_string(static_cast<int>(std::lround(100 * ratio))) + " %";
}

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

std::string whyLost(const ScanResult& result) {
  const std::string fits = percent(result.hit_ratio) + " of the scan fits the map";
  switch (result.refusal) {
    case Refusal::kTooFar:
      return fits +
             ", but farther from the predicted pose than the sensor can have moved "
             "(mapper/max_speed, mapper/max_turn)";
    case Refusal::kBlocked:
      return fits + ", but it would see through walls there: " + percent(result.blocked) +
             " of its lines of sight, " + percent(result.most_blocked) + " may";
    case Refusal::kDisagrees:
      return fits + ", but in one direction next to nothing does";
    case Refusal::kOutOfGrid:
      return "the pose found is out of the grid's range";
    case Refusal::kNotFound:
      return "it was not found in the map; where it fits best, " + percent(result.hit_share) +
             " of its points lie in occupied voxels";
    case Refusal::kCancelled:
      return "the search in the map was ended by a service, a pose or the end of the nodelet";
    default:
      return fits + ", " + percent(result.required_hit_ratio) + " must";
  }
}

}  // namespace

StageTimes timesOf(const ScanReport& report) {
  return {report.voxelize, report.extract, report.match, report.insert, report.label};
}

std::string adviceOn(const ScanResult& result, const std::string& way_out) {
  switch (result.status) {
    case ScanStatus::kLost:
      return whyLost(result) + "; the map is as before: go back to a mapped place, or " + way_out;
    case ScanStatus::kAmbiguous:
      return percent(result.hit_ratio) +
             " of the scan fits the map in more than one place; the map is as before: move on to "
             "where the surroundings differ, or " +
             way_out;
    case ScanStatus::kStale:
      if (result.ahead) {
        return "its stamp is later than that of the last scan by more than mapper/clock_leap; the "
               "next one is used if it is as late: if there was a long pause all is well, else see "
               "to the driver's clock";
      }
      return "its stamp or sweep is not later than that of the scan before; if all scans are like "
             "this, the driver's stamps stand still or two drivers publish on one topic";
    case ScanStatus::kTooFew:
      return "it has too few voxels to be matched; is the sensor covered, or min_range too large?";
    case ScanStatus::kTooLarge:
      return "it has more voxels than voxelizer/max_voxels; choose a larger voxel_size or a "
             "smaller "
             "voxelizer/max_range";
    default:
      return "";
  }
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
