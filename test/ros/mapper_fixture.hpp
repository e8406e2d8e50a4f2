// SPDX-License-Identifier: BSD-3-Clause
// A mapper nodelet that is fed with the scans of a simulated walk.
#pragma once

#include <edgevox/SaveMap.h>
#include <edgevox/ScanReport.h>
#include <edgevox/VoxelScanStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <tf2_msgs/TFMessage.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "edgevox/config.hpp"
#include "edgevox/scan/voxel_scan.hpp"
#include "edgevox/tracking/scan_result.hpp"
#include "ros/nodelet_fixture.hpp"
#include "tools/simulated_bag.hpp"

namespace edgevox::test {

using Scans = std::vector<VoxelScanStamped>;
using Transforms = std::vector<geometry_msgs::TransformStamped>;

constexpr int kScans = 18;
constexpr size_t kMiddle = 8;

/// The walk; number i is of cloud i.
const SimulatedRun& walk();

/// As from a voxelizer and an edge extractor of this configuration.
VoxelScanStamped edgesOf(VoxelScan scan, const ros::Time& stamp, const Config& config = {});

const Scans& scans();
Scans firstScans(size_t count);

ros::Time stampAfter(size_t scan, double seconds);

/// The scan at another time.
VoxelScanStamped shifted(size_t i, double seconds);

/// Points at random, which fit no map.
VoxelScanStamped randomScan(const ros::Time& stamp, uint32_t seed = 7);

/// What the core makes of the scans; `priors` is empty or has one for each.
std::vector<ScanResult> mapped(const Scans& scans, const std::vector<ScanPrior>& priors = {},
                               const Config& config = {});

std::vector<Pose> posesOf(const std::vector<ScanResult>& results);

/// Poses of the first scans of the walk.
const std::vector<Pose>& walkPoses();

bool same(const Pose& a, const geometry_msgs::Pose& b);
bool same(const Pose& a, const geometry_msgs::Transform& b);

class MapperTest : public NodeletTest {
 protected:
  MapperTest();
  ~MapperTest() override;

  void TearDown() override;

  void start(int queue_size = 100, const std::string& node = "mapper");

  void send(const VoxelScanStamped& scan);
  bool allReported() const;
  /// Sends them and waits for their reports.
  void map(const Scans& scans);

  std::string statusOf(size_t report) const;
  std::string lastStatus() const;

  /// Waits until the nodelet has its map.
  void expectService(const std::string& name) const;

  void publishStatic(const Transforms& transforms);
  void publishTf(const Transforms& transforms);

  /// The transforms to a frame from the map, of the scans that are reported.
  Transforms transformsTo(const std::string& child);

  /// Waits for the odometry of the poses, in this order and no other.
  void expectOdometry(const std::vector<Pose>& poses);

  template <typename Service>
  typename Service::Response call(const std::string& name, Service service = {}) {
    expectService(name);
    EXPECT_TRUE(callService(resolved(name), service)) << name;
    return service.response;
  }
  SaveMap::Response save(const std::string& folder, bool full = false);

  ros::Publisher voxels_;
  Listener<ScanReport> reports_{resolved("scan_report")};
  Listener<nav_msgs::Odometry> odometry_{resolved("odom")};

 private:
  bool collect(const std::string& mark, const std::string& child, Transforms& found) const;

  size_t sent_ = 0;
  int marks_ = 0;
  Listener<tf2_msgs::TFMessage> tf_{"/tf"};
  ros::Publisher tf_publisher_ = advertise<tf2_msgs::TFMessage>("/tf", 1000);
  ros::Publisher static_tf_;
};

}  // namespace edgevox::test
