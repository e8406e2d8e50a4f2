// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <edgevox/ScanReport.h>
#include <edgevox/VoxelScanStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "edgevox/edges/recent_edges.hpp"
#include "edgevox/tracking/clock_watch.hpp"
#include "edgevox/tracking/scan_result.hpp"
#include "nodes/tracking_status.hpp"
#include "ros/conversions/scan_transforms.hpp"
#include "ros/live/map_transform.hpp"
#include "ros/live/parameters.hpp"
#include "ros/live/pose_publisher.hpp"
#include "ros/live/scan_input.hpp"
#include "ros/live/service_offers.hpp"
#include "ros/live/throttled_log.hpp"
#include "ros/live/transform_input.hpp"

namespace edgevox {

/// What goes in and out of a node that finds where the sensor is, whatever its algorithm: scans
/// from `voxels` with their transforms, one after another, and poses from `initialpose`; out of it
/// TF, `odom`, `path`, a `scan_report` for every scan, and the state of all this. Safe to use from
/// several threads.
class TrackingIo {
 public:
  /// Locates a scan, calls publishPose() and gives the scan's report.
  using Locate = std::function<ScanReport(const VoxelScanStamped&, const ScanTransforms&)>;
  /// Of the scans so far.
  struct Counts {
    std::map<std::string, size_t> left_out;  // by reason
    uint64_t refused = 0;                    // see ScanReport
    uint64_t dropped = 0;
  };

  /// `parameters` and `log` must outlive this.
  TrackingIo(const ros::NodeHandle& handle, const TrackingParameters& parameters, ThrottledLog& log,
             Locate locate);

  /// To add to, before start(), beside `pause` and `resume`.
  ServiceOffers& services() { return services_; }
  /// Takes scans from now on and offers the services. `load`, if there is any, is called before the
  /// first scan, in their thread; the services tell that it has ended.
  void start(std::function<void()> load);
  /// Interrupts what is going on and all that is to come, and waits for services that run: before
  /// what they and the scans use is destroyed.
  void end();

  /// The pose of a scan, or that it has none, to TF, `odom` and `path`. Gives the time since the
  /// arrival of the cloud; 0 if that is not known [s].
  float publishPose(const VoxelScanStamped& scan, const ScanResult& result,
                    const ScanTransforms& transforms);
  /// To `scan_edges`, of the last located scan.
  void publishScanEdges(const RecentEdges& edges) const;
  void publishPath();

  /// Where the sensor is told to be, at most once for each time that it is: by `initialpose`,
  /// pointTo() or, after a pause, where it was.
  std::optional<Pose> takePose(const ScanTransforms& transforms);
  void pointTo(const Pose& T_map_base);
  /// Forgets what takePose() would give now or after a pause, and interrupts.
  void forgetPlace();

  /// Becomes true when a search that is going on has lost its point, and false by takePose().
  const std::atomic<bool>& interrupted() const { return interrupted_; }
  void interrupt() { interrupted_ = true; }

  /// The poses from now on do not go on from those so far.
  void forgetPoses();
  /// As before the first scan.
  void reset();

  Counts counts() const;
  /// Of the last located scan.
  ros::Time lastStamp() const;
  /// All that is known beside the map.
  void fill(DiagnosticStatus& status);

 private:
  using Input = ScanInput<VoxelScanStamped>;
  using Trigger = std_srvs::Trigger;

  void process(const Input::Arrival& arrival);
  void watchClock(double stamp);
  void waitForTransforms(const Input::Arrival& arrival) const;
  void publishTransform(const VoxelScanStamped& scan, const ScanResult& result,
                        const ScanTransforms& transforms);
  void leaveOut(const VoxelScanStamped& scan, const ScanRefusal& refusal);
  void report(ScanReport report);
  void takeInitialPose(const geometry_msgs::PoseWithCovarianceStamped& message);
  bool pause(Trigger::Request& request, Trigger::Response& response);
  bool resume(Trigger::Request& request, Trigger::Response& response);

  ServiceOffers services_;
  const TrackingParameters& parameters_;
  ThrottledLog& log_;
  ros::NodeHandle handle_;
  Locate locate_;
  TransformInput transforms_;
  ClockWatch clock_watch_;
  ros::Publisher reports_;
  ros::Publisher scan_edges_;
  std::atomic<bool> interrupted_{false};
  std::atomic<bool> paused_{false};

  mutable std::mutex mutex_;  // of all below, up to the input
  ScanTransformer transformer_;
  MapTransform map_transform_;
  PosePublisher pose_publisher_;
  TrackingStatus status_;
  Counts counts_;
  std::optional<Pose> pointed_;     // T_map_base, not taken yet
  std::optional<Pose> T_map_base_;  // of the last located scan
  ros::Time last_stamp_;            // of that scan
  uint64_t dropped_told_ = 0;
  uint64_t transforms_told_ = 0;  // as refused
  bool ending_ = false;

  Input input_;
  ros::Subscriber initial_pose_;
};

}  // namespace edgevox
