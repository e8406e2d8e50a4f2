// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/localizer_node.hpp"

#include <geometry_msgs/PoseArray.h>

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "edgevox/io/pose_text.hpp"
#include "nodes/load_map.hpp"
#include "nodes/scan_report.hpp"
#include "ros/conversions/pose_messages.hpp"
#include "ros/conversions/voxel_scan_message.hpp"

namespace edgevox {

LocalizerNode::LocalizerNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                             const std::string& name)
    : log_(name),
      parameters_(readLocalizerParameters(private_handle)),
      candidates_(
          ros::NodeHandle(handle).advertise<geometry_msgs::PoseArray>("candidates", 1, true)),
      map_publisher_(handle, parameters_.map_frame),
      io_(handle, parameters_, log_,
          [this](const VoxelScanStamped& scan, const ScanTransforms& transforms) {
            return locate(scan, transforms);
          }),
      map_timer_(handle.createWallTimer(ros::WallDuration(parameters_.map_period),
                                        [this](const ros::WallTimerEvent&) { publishMap(); })),
      diagnostics_(handle, private_handle, name,
                   [this](DiagnosticStatus& status) { diagnose(status); }) {
  if (const auto pose = poseOfText(parameters_.initial_pose)) io_.pointTo(*pose);
  io_.services().add("load_map", &LocalizerNode::loadMap, this);
  io_.services().add("search", &LocalizerNode::search, this);
  std::function<void()> load;
  if (parameters_.map) load = [this] { loadGivenMap(); };
  io_.start(std::move(load));
}

LocalizerNode::~LocalizerNode() { io_.end(); }

/// In the thread of the scans.
void LocalizerNode::loadGivenMap() {
  try {
    load(*parameters_.map);
  } catch (const std::exception& error) {
    const std::lock_guard<std::mutex> lock(mutex_);
    map_error_ = error.what();
    ROS_ERROR_STREAM(map_error_);
  }
  parameters_.map.reset();
}

void LocalizerNode::load(const MapFile& file) {
  auto map = std::make_shared<const MatchMap>(file.matchMap());
  auto loaded = std::make_unique<Localizer>(parameters_.config, *map, Clock::kWall);
  loaded->setControl({kAllProcessors, &io_.interrupted(), &percent_});
  const std::lock_guard<std::mutex> lock(mutex_);
  loaded_ = std::move(loaded);
  map_ = std::move(map);
  map_error_.clear();
  ++map_version_;
  io_.interrupt();
}

ScanReport LocalizerNode::locate(const VoxelScanStamped& scan, const ScanTransforms& transforms) {
  const auto pose = io_.takePose(transforms);
  const std::string error = takeRequests();
  if (!error.empty()) return reportOn(scan, noMap(error));
  if (pose) localizer_->lookNear(*pose);
  tellState();
  const ScanResult result = localizer_->process(
      voxelsToMatch(fromMessage(scan), parameters_.config.mapper.scan_voxels), transforms.prior());
  if (result.clock_jumped) {
    log_.warn("clock_jump", "the stamps have jumped back: the velocity is forgotten");
    const std::lock_guard<std::mutex> lock(mutex_);
    ++map_version_;  // rviz has forgotten the map
  }
  const float latency = io_.publishPose(scan, result, transforms);
  if (result.located()) io_.publishScanEdges(localizer_->recentEdges());
  publishCandidates(scan.header.stamp, transforms);
  tellState();
  ScanReport report =
      reportOn(scan, result, "tell where the sensor is ('2D Pose Estimate' in rviz)");
  report.latency = latency;
  return report;
}

void LocalizerNode::tellState() {
  looking_ = localizer_->isLooking();
  comparing_ = localizer_->isComparing();
}

/// Why there is no localizer; empty if there is one.
std::string LocalizerNode::takeRequests() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (loaded_) {
    localizer_ = std::move(loaded_);
    io_.reset();
  }
  if (localizer_ && look_everywhere_) localizer_->lookEverywhere();
  look_everywhere_ = false;
  return map_error_;
}

/// None, once, when the sensor is found.
void LocalizerNode::publishCandidates(const ros::Time& stamp, const ScanTransforms& transforms) {
  const std::vector<Pose> poses = localizer_->candidates();
  if (poses.empty() && candidate_count_ == 0) return;
  candidate_count_ = poses.size();
  geometry_msgs::PoseArray message;
  message.header.stamp = stamp;
  message.header.frame_id = parameters_.map_frame;
  for (const Pose& T_map_sensor : poses) {
    message.poses.push_back(toMessage(Pose(T_map_sensor * transforms.T_base_sensor.inverse())));
  }
  candidates_.publish(message);
}

void LocalizerNode::publishMap() {
  const std::lock_guard<std::mutex> publishing(publishing_);
  io_.publishPath();
  std::optional<MapSnapshot> snapshot;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (map_ && map_publisher_.isDue(map_version_)) {
      snapshot = snapshotOf(map_);
      snapshot->version = map_version_;
      snapshot->start = map_version_;
      snapshot->stamp = io_.lastStamp();
    }
  }
  if (snapshot) map_publisher_.publish(*snapshot);
}

bool LocalizerNode::loadMap(LoadMap::Request& request, LoadMap::Response& response) {
  return answer(response, log_, [&] {
    const MapFile file = readMapFile(request.file, parameters_);
    io_.forgetPlace();
    load(file);
    return loadedText(request.file, file) + "; the next scan is looked for everywhere in it";
  });
}

bool LocalizerNode::search(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  return answer(response, log_, [&] {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!map_error_.empty()) throw MapFileError(map_error_);
    look_everywhere_ = true;
    io_.forgetPlace();
    return std::string("the next scan is looked for everywhere in the map");
  });
}

void LocalizerNode::diagnose(DiagnosticStatus& status) {
  std::unique_lock<std::mutex> lock(mutex_);
  const std::shared_ptr<const MatchMap> map = map_;
  const std::string map_error = map_error_;
  lock.unlock();
  io_.fill(status);
  if (!map_error.empty()) status.mergeSummary(DiagnosticStatus::ERROR, map_error);
  const size_t candidates = candidate_count_;
  if (looking_) {
    warn(comparing_
             ? "the sensor is at one of " + std::to_string(candidates) + " places that look alike"
             : "the sensor is looked for in the map, " + std::to_string(percent_) + " % done",
         status);
  }
  status.add("candidates", candidates);
  if (!map) return;
  status.add("edge voxels of the map", map->edgeVoxels().voxelCount());
  status.add("occupied voxels of the map", map->hitVoxels().voxelCount());
  status.addf("map in memory [MB]", "%.2f", static_cast<double>(map->bytes()) / 1e6);
}

}  // namespace edgevox
