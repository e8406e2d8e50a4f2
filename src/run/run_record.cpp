// SPDX-License-Identifier: BSD-3-Clause
#include "run/run_record.hpp"

#include <algorithm>
#include <limits>

namespace edgevox {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

PoseRecord recordOf(double stamp, const Pose& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d& t = pose.translation();
  return {stamp, {q.x(), q.y(), q.z(), q.w()}, {t.x(), t.y(), t.z()}};
}

Pose poseOf(const PoseRecord& record) {
  const auto& [x, y, z, w] = record.rotation;
  Pose pose(Eigen::Quaterniond(w, x, y, z));
  pose.translation() = Eigen::Vector3d::Map(record.translation.data());
  return pose;
}

}  // namespace

void RunRecord::add(uint64_t cloud, const PipelineResult& result, const Pose& T_base_sensor,
                    double total, double latency) {
  const ScanResult& scan = result.scan;
  ScanRecord record;
  record.cloud = cloud;
  record.stamp = scan.stamp;
  record.status = scan.status;
  record.hit_ratio = static_cast<float>(scan.hit_ratio);
  record.points = static_cast<uint32_t>(result.points);
  record.voxels = static_cast<uint32_t>(result.scan_voxels);
  record.sparse_share = static_cast<float>(result.edges ? result.edges->sparseShare() : kUnknown);
  record.times = scan.times;
  if (!result.edges) record.times.extract = static_cast<float>(kUnknown);
  record.total = static_cast<float>(total);
  record.latency = static_cast<float>(latency);
  scans.grow() = record;

  if (scan.begun_anew) {
    ++begun_anew;
    poses = {};
  }
  if (scan.located()) {
    poses.grow() = recordOf(scan.stamp, scan.T_map_sensor * T_base_sensor.inverse());
  }
  if (scan.odometry_jumped) ++odometry_jumps;
  if (scan.degeneracy.directions > 0) ++degenerate;
  if (scan.clock_jumped) ++clock_jumps;
  points += result.points;
  dropped_points += result.dropped;
}

Trajectory RunRecord::trajectory() const {
  Trajectory trajectory;
  trajectory.reserve(poses.size());
  for (const PoseRecord& record : poses) trajectory.push_back({record.stamp, poseOf(record)});
  return trajectory;
}

size_t RunRecord::count(ScanStatus status) const {
  size_t count = 0;
  for (const ScanRecord& record : scans) count += record.status == status ? 1 : 0;
  return count;
}

}  // namespace edgevox
