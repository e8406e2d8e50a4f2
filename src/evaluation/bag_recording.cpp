// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/bag_recording.hpp"

#include <utility>

#include "edgevox/io/trajectory_evaluation.hpp"
#include "evaluation/bag_clouds.hpp"
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

std::vector<RecordedScan> readScans(BagReader& bag, const RecordingOptions& options) {
  std::vector<RecordedScan> scans;
  forEachReadable(bag, [&](size_t index, const auto& message, const CloudView& view) {
    if (isWanted(index, scans.size(), options)) scans.push_back(scanOf(message, view));
  });
  return scans;
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
    static_cast<SensorMotion&>(scan) = motionAt(trajectory, match.reference);
    recording.scans.push_back(std::move(scan));
  }
  recording.without_pose = scans.size() - recording.scans.size();
  return recording;
}

}  // namespace edgevox
