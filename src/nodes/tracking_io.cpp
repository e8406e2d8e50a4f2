// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/tracking_io.hpp"

#include <cmath>
#include <utility>

#include "nodes/scan_report.hpp"
#include "ros/conversions/map_messages.hpp"
#include "ros/conversions/pose_messages.hpp"
#include "ros/conversions/voxel_scan_message.hpp"

namespace edgevox {
namespace {

constexpr double kTransformCache = 30.0;    // [s]
constexpr double kPoll = 0.002;             // of TF [s]
constexpr double kLongestLatency = 3600.0;  // more is a scan from a bag [s]
constexpr double kUnitTolerance = 0.01;     // of a quaternion

/// Time since the arrival of the cloud; 0 if that was on another day or computer [s].
float latencyOf(const VoxelScanStamped& scan) {
  const double seconds = ros::WallTime::now().toSec() - scan.arrival.toSec();
  return seconds > 0 && seconds < kLongestLatency ? static_cast<float>(seconds) : 0.0F;
}

bool isPose(const geometry_msgs::Pose& message, double voxel_size) {
  const auto& q = message.orientation;
  const double norm = Eigen::Vector4d(q.x, q.y, q.z, q.w).norm();
  return std::abs(norm - 1.0) < kUnitTolerance && inGridRange(poseOf(message), voxel_size);
}

}  // namespace

TrackingIo::TrackingIo(const ros::NodeHandle& handle, const TrackingParameters& parameters,
                       ThrottledLog& log, Locate locate)
    : services_(handle),
      parameters_(parameters),
      log_(log),
      handle_(handle),
      locate_(std::move(locate)),
      transforms_(handle, ros::Duration(kTransformCache), parameters.config.mapper.clock_leap, log),
      clock_watch_(parameters.config.mapper.clock_jump, parameters.config.mapper.clock_leap),
      reports_(ros::NodeHandle(handle).advertise<ScanReport>("scan_report", 100)),
      scan_edges_(ros::NodeHandle(handle).advertise<sensor_msgs::PointCloud2>("scan_edges", 2)),
      transformer_(SensorFrames(transforms_.transforms().buffer(), parameters.frames)),
      map_transform_(handle, transforms_.transforms(), parameters.map_frame,
                     parameters.frames.odom),
      pose_publisher_(handle, parameters.map_frame, parameters.frames.base, parameters.path_length),
      input_(
          handle, parameters.config.mapper.scan_voxels == ScanVoxels::kEdges ? "edges" : "voxels",
          parameters.queue_size, log, [this](const Input::Arrival& arrival) { process(arrival); }) {
}

void TrackingIo::start(std::function<void()> load) {
  services_.add("pause", &TrackingIo::pause, this);
  services_.add("resume", &TrackingIo::resume, this);
  initial_pose_ = handle_.subscribe("initialpose", 1, &TrackingIo::takeInitialPose, this);
  if (!load) {
    input_.start();
    services_.start();
    return;
  }
  input_.start([this, load = std::move(load)] {
    load();
    services_.start();
  });
}

void TrackingIo::end() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
    interrupt();
  }
  services_.withdraw();
}

void TrackingIo::process(const Input::Arrival& arrival) {
  const VoxelScanStamped& scan = *arrival.message;
  if (const auto refusal = refusalOf(scan, parameters_.config)) return leaveOut(scan, *refusal);
  watchClock(scan.header.stamp.toSec());
  waitForTransforms(arrival);
  if (input_.stopping()) return;
  std::unique_lock<std::mutex> lock(mutex_);
  const auto transforms = transformer_.transformsOf(scan.header);
  lock.unlock();
  if (const auto* unusable = std::get_if<ScanRefusal>(&transforms)) {
    return leaveOut(scan, *unusable);
  }
  const auto& usable = std::get<ScanTransforms>(transforms);
  if (!paused_) return report(locate_(scan, usable));
  publishTransform(scan, {}, usable);  // that of an odometry frame stays as it is
  leaveOut(scan, {"paused", "call resume to go on"});
}

/// After a jump back TF would refuse the transforms of the new time, as too old.
void TrackingIo::watchClock(double stamp) {
  const ClockWatch::Order order = clock_watch_.check(stamp);
  if (order == ClockWatch::Order::kJumpedBack) transforms_.clear();
  if (order == ClockWatch::Order::kInTime || order == ClockWatch::Order::kJumpedBack) {
    clock_watch_.accept(stamp);
  }
}

void TrackingIo::waitForTransforms(const Input::Arrival& arrival) const {
  const std_msgs::Header& header = arrival.message->header;
  const ros::WallTime until = arrival.time + ros::WallDuration(parameters_.transform_wait);
  while (!(transformer_.isReady(header) && map_transform_.isReady(header)) &&
         ros::WallTime::now() < until && !input_.stopping()) {
    ros::WallDuration(kPoll).sleep();
  }
}

float TrackingIo::publishPose(const VoxelScanStamped& scan, const ScanResult& result,
                              const ScanTransforms& transforms) {
  const std::string number = "scan " + std::to_string(scan.number);
  if (result.odometry_jumped) {
    log_.warn("odometry_jump",
              number + " is predicted at constant velocity: " + odometryJumpText());
  }
  if (!transforms.odometry_error.empty()) {
    log_.warn("no_odometry",
              number + " is predicted at constant velocity: " + transforms.odometry_error);
  }
  publishTransform(scan, result, transforms);
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.setOdometryError(transforms.odometry_error);
  if (result.located()) {
    if (pose_publisher_.publish(scan.header, result, transforms.T_base_sensor)) {
      T_map_base_ = result.T_map_sensor * transforms.T_base_sensor.inverse();
    } else {
      log_.warn("not_finite", "the pose of " + number +
                                  " is not finite and not published; call reset for a new map");
    }
    last_stamp_ = scan.header.stamp;
  }
  return latencyOf(scan);
}

void TrackingIo::publishTransform(const VoxelScanStamped& scan, const ScanResult& result,
                                  const ScanTransforms& transforms) {
  if (!parameters_.publish_tf || result.status == ScanStatus::kStale) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::string error = map_transform_.publish(scan.header, result, transforms);
  status_.setTransformError(error);
  if (!error.empty()) log_.warn("transform", "no pose on TF: " + error);
}

void TrackingIo::publishScanEdges(const RecentEdges& edges) const {
  if (scan_edges_.getNumSubscribers() == 0) return;
  std_msgs::Header header;
  header.stamp = lastStamp();
  header.frame_id = parameters_.map_frame;
  scan_edges_.publish(toCloud(edges.edgeCentroids(), header));
}

void TrackingIo::publishPath() {
  std::unique_lock<std::mutex> lock(mutex_);
  const auto path = pose_publisher_.takePath();
  lock.unlock();
  if (path) pose_publisher_.publish(*path);
}

void TrackingIo::leaveOut(const VoxelScanStamped& scan, const ScanRefusal& refusal) {
  std::unique_lock<std::mutex> lock(mutex_);
  ++counts_.left_out[refusal.reason];
  lock.unlock();
  report(reportOn(scan, refusal));
}

void TrackingIo::report(ScanReport report) {
  report.dropped += input_.dropped();
  if (!report.located) {
    log_.warn(report.status, "scan " + std::to_string(report.number) + " is " + report.status +
                                 ": " + report.text);
  }
  std::unique_lock<std::mutex> lock(mutex_);
  status_.add(report);
  counts_.refused = report.refused;
  counts_.dropped = report.dropped;
  lock.unlock();
  reports_.publish(report);
}

void TrackingIo::takeInitialPose(const geometry_msgs::PoseWithCovarianceStamped& message) {
  const std::string frame = withoutSlash(message.header.frame_id);
  if (frame != withoutSlash(parameters_.map_frame)) {
    log_.warn("initialpose", "a pose on initialpose is in frame '" + frame + "' and not used; '" +
                                 parameters_.map_frame + "' is needed (in rviz: Fixed Frame)");
  } else if (!isPose(message.pose.pose, parameters_.config.voxel_size)) {
    log_.warn("initialpose",
              "a pose on initialpose is not finite, too far from the map's origin, or its "
              "quaternion is none, and not used");
  } else {
    pointTo(poseOf(message.pose.pose));
  }
}

void TrackingIo::pointTo(const Pose& T_map_base) {
  const std::lock_guard<std::mutex> lock(mutex_);
  pointed_ = T_map_base;
  interrupt();
}

void TrackingIo::forgetPlace() {
  const std::lock_guard<std::mutex> lock(mutex_);
  pointed_.reset();
  T_map_base_.reset();
  interrupt();
}

std::optional<Pose> TrackingIo::takePose(const ScanTransforms& transforms) {
  const std::lock_guard<std::mutex> lock(mutex_);
  interrupted_ = ending_ || paused_;
  if (!pointed_) return std::nullopt;
  const Pose T_map_sensor = *pointed_ * transforms.T_base_sensor;
  pointed_.reset();
  return T_map_sensor;
}

bool TrackingIo::pause(Trigger::Request&, Trigger::Response& response) {
  paused_ = true;
  interrupt();
  response.message = "scans are left out; the map and the pose stay as they are";
  response.success = static_cast<uint8_t>(true);
  return true;
}

/// Meanwhile the sensor may have been moved.
bool TrackingIo::resume(Trigger::Request&, Trigger::Response& response) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (paused_ && !pointed_) pointed_ = T_map_base_;
  paused_ = false;
  response.message =
      pointed_ ? "the next scan is looked for near the last pose first" : "the next scan is used";
  response.success = static_cast<uint8_t>(true);
  return true;
}

void TrackingIo::forgetPoses() {
  const std::lock_guard<std::mutex> lock(mutex_);
  pose_publisher_.reset();
  T_map_base_.reset();
}

void TrackingIo::reset() {
  forgetPoses();
  const std::lock_guard<std::mutex> lock(mutex_);
  transformer_.reset();
  map_transform_.reset();
  pointed_.reset();
  counts_ = {};
  status_ = {};
  dropped_told_ = input_.dropped();
}

TrackingIo::Counts TrackingIo::counts() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return counts_;
}

ros::Time TrackingIo::lastStamp() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return last_stamp_;
}

void TrackingIo::fill(DiagnosticStatus& status) {
  const InputReading reading = input_.reading();
  const TransformReading transforms = transforms_.reading();
  const std::string missing = services_.missing();
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.fill(status);
  if (paused_) warn("paused: call resume to go on", status);
  addInput(reading, dropped_told_, status);
  addTransforms(transforms, transforms_told_, status);
  if (!missing.empty()) warn("services " + missing, status);
}

}  // namespace edgevox
