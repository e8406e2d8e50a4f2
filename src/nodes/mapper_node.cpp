// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/mapper_node.hpp"

#include <optional>

#include "nodes/save_run.hpp"
#include "ros/conversions/map_messages.hpp"
#include "ros/conversions/voxel_scan_message.hpp"

namespace edgevox {
namespace {

constexpr double kTransformCache = 30.0;    // [s]
constexpr double kPoll = 0.002;             // of TF [s]
constexpr double kLongestLatency = 3600.0;  // more is a scan from a bag [s]

/// Time since the arrival of the cloud; 0 if that was on another day or computer [s].
float latencyOf(const VoxelScanStamped& scan) {
  const double seconds = ros::WallTime::now().toSec() - scan.arrival.toSec();
  return seconds > 0 && seconds < kLongestLatency ? static_cast<float>(seconds) : 0.0F;
}

}  // namespace

MapperNode::MapperNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                       const std::string& name)
    : log_(name),
      parameters_(readMapperParameters(private_handle)),
      transforms_(handle, ros::Duration(kTransformCache), parameters_.config.mapper.clock_leap,
                  log_),
      clock_watch_(parameters_.config.mapper.clock_jump, parameters_.config.mapper.clock_leap),
      reports_(ros::NodeHandle(handle).advertise<ScanReport>("scan_report", 100)),
      scan_edges_(ros::NodeHandle(handle).advertise<sensor_msgs::PointCloud2>("scan_edges", 2)),
      map_publisher_(handle, parameters_.map_frame),
      transformer_(SensorFrames(transforms_.transforms().buffer(), parameters_.frames)),
      map_transform_(handle, transforms_.transforms(), parameters_.map_frame,
                     parameters_.frames.odom),
      pose_publisher_(handle, parameters_.map_frame, parameters_.frames.base,
                      parameters_.path_length),
      mapper_(parameters_.config, Clock::kWall),
      input_(handle, "voxels", parameters_.queue_size, log_,
             [this](const Input::Arrival& arrival) { process(arrival); }),
      map_timer_(handle.createWallTimer(ros::WallDuration(parameters_.map_period),
                                        [this](const ros::WallTimerEvent&) { publishMap(); })),
      services_(handle),
      diagnostics_(handle, private_handle, name,
                   [this](DiagnosticStatus& status) { diagnose(status); }) {
  services_.add("save_map", &MapperNode::saveMap, this);
  services_.add("reset", &MapperNode::reset, this);
  services_.start();
}

void MapperNode::process(const Input::Arrival& arrival) {
  const VoxelScanStamped& scan = *arrival.message;
  const auto refusal = refusalOf(scan, parameters_.config);
  if (!refusal) {
    watchClock(scan.header.stamp.toSec());
    waitForTransforms(arrival);
  }
  if (input_.stopping()) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (refusal) {
    ++run_.left_out[refusal->reason];
    return report(reportOn(scan, *refusal));
  }
  const auto transforms = transformer_.transformsOf(scan.header);
  if (const auto* unusable = std::get_if<ScanRefusal>(&transforms)) {
    ++run_.left_out[unusable->reason];
    return report(reportOn(scan, *unusable));
  }
  report(map(scan, std::get<ScanTransforms>(transforms)));
}

/// After a jump back TF would refuse the transforms of the new time, as too old.
void MapperNode::watchClock(double stamp) {
  const ClockWatch::Order order = clock_watch_.check(stamp);
  if (order == ClockWatch::Order::kJumpedBack) transforms_.clear();
  if (order == ClockWatch::Order::kInTime || order == ClockWatch::Order::kJumpedBack) {
    clock_watch_.accept(stamp);
  }
}

void MapperNode::waitForTransforms(const Input::Arrival& arrival) const {
  const std_msgs::Header& header = arrival.message->header;
  const ros::WallTime until = arrival.time + ros::WallDuration(parameters_.transform_wait);
  while (!(transformer_.isReady(header) && map_transform_.isReady(header)) &&
         ros::WallTime::now() < until && !input_.stopping()) {
    ros::WallDuration(kPoll).sleep();
  }
}

ScanReport MapperNode::map(const VoxelScanStamped& scan, const ScanTransforms& transforms) {
  const VoxelScan voxels = fromMessage(scan);
  ScanResult result = mapper_.track(voxels, transforms.prior());
  if (result.clock_jumped) clockJumped();
  if (result.begun_anew) begunAnew(scan.number);
  if (result.odometry_jumped) {
    log_.warn("odometry_jump", "scan " + std::to_string(scan.number) +
                                   " is predicted at constant velocity: " + odometryJumpText());
  }
  publishPose(scan, result, transforms);
  const float latency = latencyOf(scan);
  if (result.located()) {
    mapper_.insert(voxels, result);
    ++map_version_;
    publishScanEdges(scan.header.stamp);
  }
  if (mapper_.map().isFull()) log_.warn("map_full", fullText(parameters_.config.map));
  ScanReport report = reportOn(scan, result);
  report.latency = latency;
  const auto total = static_cast<double>(timesOf(report).total());
  run_.time_field = scan.time_field;
  run_.add(scan.number, toPipelineResult(scan, result), transforms.T_base_sensor, total,
           static_cast<double>(report.latency));
  return report;
}

void MapperNode::clockJumped() {
  const bool cleared = parameters_.config.mapper.after_clock_jump == AfterClockJump::kClearMap;
  if (cleared) pose_publisher_.reset();
  ++map_version_;
  ++map_start_;
  log_.warn("clock_jump",
            "the stamps have jumped back: the velocity is forgotten, and the map is " +
                std::string(cleared ? "cleared" : "kept; call reset for a new one"));
}

void MapperNode::begunAnew(uint64_t scan) {
  pose_publisher_.reset();
  ++map_version_;
  ++map_start_;
  log_.warn("begun_anew", "scan " + std::to_string(scan) + ": " + begunAnewText());
}

void MapperNode::publishPose(const VoxelScanStamped& scan, const ScanResult& result,
                             const ScanTransforms& transforms) {
  if (!transforms.odometry_error.empty()) {
    ++run_.without_odometry;
    log_.warn("no_odometry",
              "scan " + std::to_string(scan.number) +
                  " is predicted at constant velocity: " + transforms.odometry_error);
  }
  status_.setOdometryError(transforms.odometry_error);
  if (parameters_.publish_tf && result.status != ScanStatus::kStale) {
    const std::string error = map_transform_.publish(scan.header, result, transforms);
    status_.setTransformError(error);
    if (!error.empty()) log_.warn("transform", "no pose on TF: " + error);
  }
  if (!result.located()) return;
  if (!pose_publisher_.publish(scan.header, result, transforms.T_base_sensor)) {
    log_.warn("not_finite", "the pose of scan " + std::to_string(scan.number) +
                                " is not finite and not published; call reset for a new map");
  }
  last_stamp_ = scan.header.stamp;
}

void MapperNode::publishScanEdges(const ros::Time& stamp) const {
  if (scan_edges_.getNumSubscribers() == 0) return;
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = parameters_.map_frame;
  scan_edges_.publish(toCloud(mapper_.recentEdges().edgeCentroids(), header));
}

void MapperNode::report(ScanReport report) {
  report.dropped += input_.dropped();
  if (!report.located) {
    log_.warn(report.status, "scan " + std::to_string(report.number) + " is " + report.status +
                                 ": " + report.text);
  }
  status_.add(report);
  run_.refused = report.refused;
  run_.dropped = report.dropped;
  reports_.publish(report);
}

void MapperNode::publishMap() {
  const std::lock_guard<std::mutex> publishing(publishing_);
  std::optional<nav_msgs::Path> path;
  std::optional<MapSnapshot> snapshot;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    path = pose_publisher_.takePath();
    if (map_publisher_.isDue(map_version_)) {
      snapshot = MapSnapshot{mapper_.map(), map_version_, map_start_, last_stamp_};
    }
  }
  if (path) pose_publisher_.publish(*path);
  if (snapshot) map_publisher_.publish(*snapshot);
}

bool MapperNode::saveMap(SaveMap::Request& request, SaveMap::Response& response) {
  const std::string folder = request.folder.empty() ? parameters_.output : request.folder;
  std::unique_lock<std::mutex> lock(mutex_);
  Mapper mapper = mapper_;
  const RunRecord run = run_;
  lock.unlock();
  try {
    response.message =
        saveRun(folder, parameters_.config, run, parameters_.map_frame, request.full != 0, mapper);
    response.success = static_cast<uint8_t>(true);
    ROS_INFO_STREAM(response.message);
  } catch (const std::exception& error) {
    response.message = error.what();
    response.success = static_cast<uint8_t>(false);
    log_.warn("save", response.message);
  }
  return true;
}

bool MapperNode::reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  const std::lock_guard<std::mutex> lock(mutex_);
  mapper_.reset();
  transformer_.reset();
  map_transform_.reset();
  pose_publisher_.reset();
  run_ = {};
  status_ = {};
  status_.droppedTold() = input_.dropped();
  ++map_version_;
  ++map_start_;
  response.message = "the map is empty; the next scan is its first";
  response.success = static_cast<uint8_t>(true);
  return true;
}

void MapperNode::diagnose(DiagnosticStatus& status) {
  const InputReading reading = input_.reading();
  const TransformReading transforms = transforms_.reading();
  const std::string missing = services_.missing();
  std::unique_lock<std::mutex> lock(mutex_);
  const MapBuilder map = mapper_.map();
  const MapperStatus state = status_;
  lock.unlock();
  state.fill(map, status);
  if (map.isFull()) warn(fullText(parameters_.config.map), status);
  lock.lock();
  addInput(reading, status_.droppedTold(), status);
  addTransforms(transforms, transforms_told_, status);
  if (!missing.empty()) warn("services " + missing, status);
}

}  // namespace edgevox
