// SPDX-License-Identifier: BSD-3-Clause
#include "ros/mapper_fixture.hpp"

#include <ros/service.h>

#include "edgevox/edges/edge_extractor.hpp"
#include "edgevox/mapping/mapper.hpp"
#include "edgevox/scan/voxelizer.hpp"
#include "ros/conversions/voxel_scan_message.hpp"
#include "ros/simulated_scans.hpp"
#include "support/sweeps.hpp"

namespace edgevox::test {
namespace {

template <typename Vector, typename Quaternion>
bool samePose(const Pose& pose, const Vector& t, const Quaternion& r) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(pose.linear()).normalized();
  return pose.translation() == Eigen::Vector3d(t.x, t.y, t.z) &&
         q.coeffs() == Eigen::Vector4d(r.x, r.y, r.z, r.w);
}

}  // namespace

const SimulatedRun& walk() {
  static const SimulatedRun run = simulateRun(kScans);
  return run;
}

VoxelScanStamped edgesOf(VoxelScan scan, const ros::Time& stamp, const Config& config) {
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

const Scans& scans() {
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

Scans firstScans(size_t count) {
  return {scans().begin(), scans().begin() + static_cast<std::ptrdiff_t>(count)};
}

ros::Time stampAfter(size_t scan, double seconds) {
  return scans()[scan].header.stamp + ros::Duration(seconds);
}

VoxelScanStamped shifted(size_t i, double seconds) {
  VoxelScanStamped scan = scans()[i];
  scan.header.stamp = stampAfter(i, seconds);
  return scan;
}

VoxelScanStamped randomScan(const ros::Time& stamp, uint32_t seed) {
  const VoxelScan scan = voxelScans({randomSweep(seed, stamp.toSec(), 20000)}, Config{}).front();
  return edgesOf(scan, stamp);
}

std::vector<ScanResult> mapped(const Scans& scans, const std::vector<ScanPrior>& priors,
                               const Config& config) {
  Mapper mapper(config);
  std::vector<ScanResult> results;
  for (size_t i = 0; i < scans.size(); ++i) {
    const ScanPrior prior = priors.empty() ? ScanPrior{} : priors[i];
    results.push_back(mapper.process(fromMessage(scans[i]), prior));
  }
  return results;
}

std::vector<Pose> posesOf(const std::vector<ScanResult>& results) {
  std::vector<Pose> poses;
  for (const ScanResult& result : results) {
    if (result.located()) poses.push_back(result.T_map_sensor);
  }
  return poses;
}

const std::vector<Pose>& walkPoses() {
  static const std::vector<Pose> poses = posesOf(mapped(scans()));
  return poses;
}

bool same(const Pose& a, const geometry_msgs::Pose& b) {
  return samePose(a, b.position, b.orientation);
}

bool same(const Pose& a, const geometry_msgs::Transform& b) {
  return samePose(a, b.translation, b.rotation);
}

MapperTest::MapperTest() = default;

MapperTest::~MapperTest() = default;

void MapperTest::TearDown() {
  NodeletTest::TearDown();
  static_tf_.shutdown();
}

void MapperTest::start(int queue_size, const std::string& node) {
  setParameter(node, "queue_size", queue_size);
  ASSERT_TRUE(load(node));
  voxels_ = advertise<VoxelScanStamped>(resolved("voxels"), 100);
  ASSERT_LE(1U, voxels_.getNumSubscribers());
}

void MapperTest::send(const VoxelScanStamped& scan) {
  publishShared(voxels_, copyOf(scan));
  ++sent_;
}

bool MapperTest::allReported() const { return reports_.waitFor(sent_); }

void MapperTest::map(const Scans& scans) {
  for (const VoxelScanStamped& scan : scans) send(scan);
  ASSERT_TRUE(allReported()) << reports_.count() << " reports";
}

std::string MapperTest::statusOf(size_t report) const {
  return reports_.messages().at(report)->status;
}

std::string MapperTest::lastStatus() const { return reports_.messages().back()->status; }

void MapperTest::expectService(const std::string& name) const {
  EXPECT_TRUE(ros::service::waitForService(resolved(name), ros::Duration(kPatience))) << name;
}

void MapperTest::publishStatic(const Transforms& transforms) {
  tf2_msgs::TFMessage message;
  message.transforms = transforms;
  static_tf_ = advertise<tf2_msgs::TFMessage>("/tf_static", 1, true);
  publish(static_tf_, message);
}

void MapperTest::publishTf(const Transforms& transforms) {
  tf2_msgs::TFMessage message;
  message.transforms = transforms;
  publish(tf_publisher_, message);
}

Transforms MapperTest::transformsTo(const std::string& child) {
  const std::string mark = "mark" + std::to_string(++marks_);  // comes after them
  publishTf({transformOf("test", mark, ros::Time(1), Pose::Identity())});
  Transforms found;
  EXPECT_TRUE(eventually([&] { return collect(mark, child, found); }));
  return found;
}

void MapperTest::expectOdometry(const std::vector<Pose>& poses) {
  ASSERT_TRUE(odometry_.waitFor(poses.size()));
  const auto messages = odometry_.messages();
  ASSERT_EQ(poses.size(), messages.size());
  for (size_t i = 0; i < poses.size(); ++i) {
    EXPECT_TRUE(same(poses[i], messages[i]->pose.pose)) << "pose " << i;
  }
}

SaveMap::Response MapperTest::save(const std::string& folder, bool full) {
  SaveMap service;
  service.request.folder = folder;
  service.request.full = static_cast<uint8_t>(full);
  return call("save_map", service);
}

bool MapperTest::collect(const std::string& mark, const std::string& child,
                         Transforms& found) const {
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

}  // namespace edgevox::test
