// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/bag_recording.hpp"

#include <utility>
#include <variant>

#include "edgevox/io/trajectory_evaluation.hpp"
#include "edgevox/mapping/pipeline.hpp"
#include "ros/conversions/point_cloud.hpp"
#include "tools/bag_reader.hpp"

namespace edgevox {
namespace {

RecordedScan scanOf(const sensor_msgs::PointCloud2& message, const CloudView& view) {
  RecordedScan scan;
  scan.bytes = message.data;
  scan.view = view;
  scan.view.data = scan.bytes.data();
  return scan;
}

/// Calls visit(index, message, view) for the clouds of use. Throws BagError for a damaged bag.
template <typename Visit>
void forEachReadable(BagReader& bag, const Visit& visit) {
  bag.forEachCloud([&](size_t index, const BagReader::ReadCloud& read) {
    const BagCloud cloud = read();
    if (!cloud.message) return;
    const CloudReading reading = readCloud(*cloud.message);
    const auto* checked = std::get_if<CheckedCloud>(&reading);
    if (checked != nullptr) visit(index, *cloud.message, checked->view);
  });
  if (!bag.losses().empty()) throw BagError(textsOf(bag.losses()).front());
}

std::vector<RecordedScan> readScans(BagReader& bag, const RecordingOptions& options) {
  std::vector<RecordedScan> scans;
  forEachReadable(bag, [&](size_t index, const auto& message, const CloudView& view) {
    if (isWanted(index, scans.size(), options)) scans.push_back(scanOf(message, view));
  });
  return scans;
}

/// What Pipeline finds with the default configuration from all clouds of the bag.
Trajectory trackedPoses(BagReader& bag) {
  Pipeline pipeline((Config()));
  Trajectory trajectory;
  forEachReadable(bag, [&](size_t, const auto&, const CloudView& view) {
    const ScanResult result = pipeline.process(view).scan;
    if (result.located()) trajectory.push_back({view.stamp, result.T_map_sensor});
  });
  return trajectory;
}

Twist twistBetween(const StampedPose& from, const StampedPose& to) {
  return twistOf(from.pose.inverse() * to.pose, to.stamp - from.stamp);
}

void place(RecordedScan& scan, const Trajectory& trajectory, size_t at) {
  scan.T_map_sensor = trajectory[at].pose;
  const bool first = at == 0;
  const bool last = at + 1 == trajectory.size();
  if (!first) scan.before = twistBetween(trajectory[at - 1], trajectory[at]);
  scan.after = last ? scan.before : twistBetween(trajectory[at], trajectory[at + 1]);
  if (first) scan.before = scan.after;
}

Trajectory stampsOf(const std::vector<RecordedScan>& scans) {
  Trajectory stamps;
  for (const RecordedScan& scan : scans) stamps.push_back({scan.view.stamp, Pose::Identity()});
  return stamps;
}

}  // namespace

Recording readBagRecording(const RecordingOptions& options) {
  BagReader bag(options.input, options.topic);
  std::vector<RecordedScan> scans = readScans(bag, options);
  const Trajectory trajectory = options.poses.empty() ? trackedPoses(bag) : readTum(options.poses);
  Recording recording;
  recording.name = std::filesystem::path(options.input).filename().string();
  recording.source = options.poses.empty() ? "found by the default configuration"
                                           : "from " + options.poses.filename().string();
  for (const StampMatch& match : matchStamps(stampsOf(scans), trajectory)) {
    RecordedScan& scan = scans[match.estimate];
    place(scan, trajectory, match.reference);
    recording.scans.push_back(std::move(scan));
  }
  recording.without_pose = scans.size() - recording.scans.size();
  return recording;
}

}  // namespace edgevox
