// SPDX-License-Identifier: BSD-3-Clause
// A mapper nodelet that is fed with the scans of a simulated walk.
#pragma once

#include <edgevox/SaveMap.h>
#include <edgevox/ScanReport.h>
#include <nav_msgs/Odometry.h>
#include <std_srvs/Trigger.h>
#include <tf2_msgs/TFMessage.h>

#include <memory>
#include <string>
#include <vector>

#include "edgevox/mapping/pipeline.hpp"
#include "edgevox/scan/voxel_scan.hpp"
#include "nodelet_fixture.hpp"
#include "ros/conversions/voxel_scan_message.hpp"
#include "ros/simulated_scans.hpp"
#include "support/sweeps.hpp"

namespace edgevox::test {

using Scans = std::vector<VoxelScanStamped>;
using Transforms = std::vector<geometry_msgs::TransformStamped>;

constexpr int kScans = 18;
constexpr size_t kMiddle = 8;

/// The walk; number i is of cloud i.
inline const SimulatedRun& walk() {
  static const SimulatedRun run = simulateRun(kScans);
  return run;
}

/// As from a voxelizer and an edge extractor of this configuration.
inline VoxelScanStamped edgesOf(VoxelScan scan, const ros::Time& stamp, const Config& config = {}) {
  const EdgeCount count = EdgeExtractor(config.edges, 1).extract(scan);
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = "lidar";
  VoxelScanStamped message = toMessage(scan, header);
  message.occupied_voxels = static_cast<uint32_t>(count.occupied);
  message.edge_voxels = static_cast<uint32_t>(count.edges);
  message.sparse_voxels = static_cast<uint32_t>(count.sparse);
  message.time_field = "time";
  addSettings(config, {"voxel_size", "voxelizer/", "edges/"}, message);
  return message;
}

inline const Scans& scans() {
  static const Scans made = [] {
    const Config config;
    Voxelizer voxelizer(config.voxelizer, config.voxel_size);
    Scans all;
    for (const auto& cloud : walk().clouds) {
      all.push_back(edgesOf(voxelizer.voxelize(viewOf(cloud)), cloud.header.stamp));
    }
    return all;
  }();
  return made;
}

inline Scans firstScans(size_t count) {
  return {scans().begin(), scans().begin() + static_cast<std::ptrdiff_t>(count)};
}

inline ros::Time stampAfter(size_t scan, double seconds) {
  return scans()[scan].header.stamp + ros::Duration(seconds);
}

/// The scan at another time.
inline VoxelScanStamped shifted(size_t i, double seconds) {
  VoxelScanStamped scan = scans()[i];
  scan.header.stamp = stampAfter(i, seconds);
  return scan;
}

/// Points at random, which fit no map.
inline VoxelScanStamped randomScan(const ros::Time& stamp, uint32_t seed = 7) {
  const VoxelScan scan = voxelScans({randomSweep(seed, stamp.toSec(), 20000)}, Config{}).front();
  return edgesOf(scan, stamp);
}

/// What the core makes of the scans; `priors` is empty or has one for each.
inline std::vector<ScanResult> mapped(const Scans& scans, const std::vector<ScanPrior>& priors = {},
                                      const Config& config = {}) {
  Mapper mapper(config);
  std::vector<ScanResult> results;
  for (size_t i = 0; i < scans.size(); ++i) {
    const ScanPrior prior = priors.empty() ? ScanPrior{} : priors[i];
    results.push_back(mapper.process(fromMessage(scans[i]), prior));
  }
  return results;
}

inline std::vector<Pose> posesOf(const std::vector<ScanResult>& results) {
  std::vector<Pose> poses;
  for (const ScanResult& result : results) {
    if (result.located()) poses.push_back(result.T_map_sensor);
  }
  return poses;
}

/// Poses of the first scans of the walk.
inline const std::vector<Pose>& walkPoses() {
  static const std::vector<Pose> poses = posesOf(mapped(scans()));
  return poses;
}

template <typename Vector, typename Quaternion>
bool samePose(const Pose& pose, const Vector& t, const Quaternion& r) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(pose.linear()).normalized();
  return pose.translation() == Eigen::Vector3d(t.x, t.y, t.z) &&
         q.coeffs() == Eigen::Vector4d(r.x, r.y, r.z, r.w);
}
inline bool same(const Pose& a, const geometry_msgs::Pose& b) {
  return samePose(a, b.position, b.orientation);
}
inline bool same(const Pose& a, const geometry_msgs::Transform& b) {
  return samePose(a, b.translation, b.rotation);
}

class MapperTest : public NodeletTest {
 protected:
  void TearDown() override {
    NodeletTest::TearDown();
    static_tf_.shutdown();
  }

  void start(int queue_size = 100, const std::string& node = "mapper") {
    setParameter(node, "queue_size", queue_size);
    ASSERT_TRUE(load(node));
    voxels_ = ros::NodeHandle().advertise<VoxelScanStamped>(resolved("voxels"), 100);
    ASSERT_LE(1U, voxels_.getNumSubscribers());
  }

  void send(const VoxelScanStamped& scan) {
    voxels_.publish(boost::make_shared<VoxelScanStamped>(scan));
    ++sent_;
  }
  bool allReported() const { return reports_.waitFor(sent_); }
  /// Sends them and waits for their reports.
  void map(const Scans& scans) {
    for (const VoxelScanStamped& scan : scans) send(scan);
    ASSERT_TRUE(allReported()) << reports_.count() << " reports";
  }

  std::string statusOf(size_t report) const { return reports_.messages().at(report)->status; }
  std::string lastStatus() const { return reports_.messages().back()->status; }

  /// Waits until the nodelet has its map.
  void expectService(const std::string& name) const {
    EXPECT_TRUE(ros::service::waitForService(resolved(name), ros::Duration(kPatience))) << name;
  }

  void publishStatic(const Transforms& transforms) {
    tf2_msgs::TFMessage message;
    message.transforms = transforms;
    static_tf_ = ros::NodeHandle().advertise<tf2_msgs::TFMessage>("/tf_static", 1, true);
    static_tf_.publish(message);
  }
  void publishTf(const Transforms& transforms) {
    tf2_msgs::TFMessage message;
    message.transforms = transforms;
    tf_publisher_.publish(message);
  }

  /// The transforms to a frame from the map, of the scans that are reported.
  Transforms transformsTo(const std::string& child) {
    const std::string mark = "mark" + std::to_string(++marks_);  // comes after them
    publishTf({transformOf("test", mark, ros::Time(1), Pose::Identity())});
    Transforms found;
    EXPECT_TRUE(eventually([&] { return collect(mark, child, found); }));
    return found;
  }

  /// Waits for the odometry of the poses, in this order and no other.
  void expectOdometry(const std::vector<Pose>& poses) {
    ASSERT_TRUE(odometry_.waitFor(poses.size()));
    const auto messages = odometry_.messages();
    ASSERT_EQ(poses.size(), messages.size());
    for (size_t i = 0; i < poses.size(); ++i) {
      EXPECT_TRUE(same(poses[i], messages[i]->pose.pose)) << "pose " << i;
    }
  }

  template <typename Service>
  typename Service::Response call(const std::string& name, Service service = {}) {
    expectService(name);
    EXPECT_TRUE(ros::service::call(resolved(name), service)) << name;
    return service.response;
  }
  SaveMap::Response save(const std::string& folder, bool full = false) {
    SaveMap service;
    service.request.folder = folder;
    service.request.full = static_cast<uint8_t>(full);
    return call("save_map", service);
  }

  ros::Publisher voxels_;
  Listener<ScanReport> reports_{resolved("scan_report")};
  Listener<nav_msgs::Odometry> odometry_{resolved("odom")};

 private:
  bool collect(const std::string& mark, const std::string& child, Transforms& found) const {
    found.clear();
    for (const auto& message : tf_.messages()) {
      for (const auto& transform : message->transforms) {
        if (transform.child_frame_id == mark) return true;
        if (transform.child_frame_id == child && transform.header.frame_id == "map") {
          found.push_back(transform);
        }
      }
    }
    return false;
  }

  size_t sent_ = 0;
  int marks_ = 0;
  Listener<tf2_msgs::TFMessage> tf_{"/tf"};
  ros::Publisher tf_publisher_ = ros::NodeHandle().advertise<tf2_msgs::TFMessage>("/tf", 1000);
  ros::Publisher static_tf_;
};

}  // namespace edgevox::test
