// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/scan_stream.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "edgevox/io/trajectory_evaluation.hpp"
#include "evaluation/bag_clouds.hpp"
#include "evaluation/scan_folder.hpp"
#include "evaluation/simulated_truth.hpp"

namespace edgevox {

TruePose poseAround(double stamp, const Trajectory& trajectory) {
  const auto matches = matchStamps({{stamp, Pose::Identity()}}, trajectory);
  if (matches.empty()) return {};
  const SensorMotion motion = motionAt(trajectory, matches.front().reference);
  return [motion](double time_offset) { return motion.poseAt(time_offset); };
}

ScanStream simulatedStream(const std::string& input) {
  const auto truth = std::make_shared<const SimulatedTruth>(simulatedTruth(input));
  return [truth](size_t most, const VisitScan& visit) {
    const auto sweeps = static_cast<size_t>(sim::countSweeps(truth->path, truth->sensor));
    for (size_t sweep = 0; sweep < std::min(sweeps, most); ++sweep) {
      const RecordedScan scan = simulatedScan(*truth, static_cast<int>(sweep));
      visit(scan.view,
            [&](double time_offset) { return truth->path.poseAt(scan.view.stamp + time_offset); });
    }
  };
}

ScanStream bagStream(const std::string& bag, const std::filesystem::path& poses,
                     const std::string& topic) {
  BagReader(bag, topic);  // throws now, not in the middle of a long run
  const auto known =
      std::make_shared<const Trajectory>(poses.empty() ? Trajectory() : readTum(poses));
  return [=](size_t most, const VisitScan& visit) {
    BagReader reader(bag, topic);
    const Trajectory trajectory = poses.empty() ? trackedPoses(reader) : *known;
    forEachReadable(
        reader,
        [&](size_t, const auto&, const CloudView& view) {
          visit(view, poseAround(view.stamp, trajectory));
        },
        most);
  };
}

std::string recordingName(const std::filesystem::path& recording) {
  const std::filesystem::path plain = std::filesystem::absolute(recording).lexically_normal();
  return (plain.has_filename() ? plain : plain.parent_path()).filename();
}

ScanStream streamOf(const std::string& input, const std::filesystem::path& poses,
                    const std::string& topic) {
  if (!isSimulated(input)) {
    return std::filesystem::is_directory(input) ? folderStream(input, poses)
                                                : bagStream(input, poses, topic);
  }
  if (poses.empty()) return simulatedStream(input);
  throw std::invalid_argument("the poses of the simulated '" + input + "' are known: leave out '" +
                              poses.string() + "'");
}

}  // namespace edgevox
