// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/recorded_scan.hpp"

#include <cstring>

namespace edgevox {
namespace {

struct PackedPoint {
  float x, y, z, time;
};

Twist twistBetween(const StampedPose& from, const StampedPose& to) {
  return twistOf(from.pose.inverse() * to.pose, to.stamp - from.stamp);
}

}  // namespace

SensorMotion motionAt(const Trajectory& trajectory, size_t at) {
  SensorMotion motion;
  motion.T_map_sensor = trajectory[at].pose;
  const bool first = at == 0;
  const bool last = at + 1 == trajectory.size();
  if (!first) motion.before = twistBetween(trajectory[at - 1], trajectory[at]);
  motion.after = last ? motion.before : twistBetween(trajectory[at], trajectory[at + 1]);
  if (first) motion.before = motion.after;
  return motion;
}

RecordedScan recordedScan(const sim::Scan& scan) {
  RecordedScan recorded;
  recorded.bytes.resize(scan.size() * sizeof(PackedPoint));
  for (size_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3f& p = scan.points[i];
    const PackedPoint point{p.x(), p.y(), p.z(), scan.times[i]};
    std::memcpy(&recorded.bytes[i * sizeof(PackedPoint)], &point, sizeof(PackedPoint));
  }
  CloudView& view = recorded.view;
  view.stamp = scan.stamp;
  view.frame = "lidar";
  view.data = recorded.bytes.data();
  view.width = scan.size();
  view.height = 1;
  view.point_step = sizeof(PackedPoint);
  view.row_step = recorded.bytes.size();
  view.time.present = true;
  view.time.offset = offsetof(PackedPoint, time);
  return recorded;
}

sim::Scan sweepOf(const RecordedScan& recorded) {
  sim::Scan scan;
  scan.stamp = recorded.view.stamp;
  for (size_t i = 0; i < recorded.view.width; ++i) {
    PackedPoint point;
    std::memcpy(&point, &recorded.bytes[i * sizeof(PackedPoint)], sizeof(PackedPoint));
    scan.points.emplace_back(point.x, point.y, point.z);
    scan.times.push_back(point.time);
  }
  return scan;
}

}  // namespace edgevox
