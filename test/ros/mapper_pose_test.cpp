// SPDX-License-Identifier: BSD-3-Clause
// edgevox/Mapper: odometry, path, TF and reports of a simulated walk.
#include <nav_msgs/Path.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/matching/symmetric6.hpp"
#include "edgevox/mapping/pipeline.hpp"
#include "ros/mapper_fixture.hpp"
#include "ros/simulated_scans.hpp"

namespace edgevox::test {
namespace {

using Row6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

template <typename Array>
Row6 matrixOf(const Array& values) {
  return Eigen::Map<const Row6>(values.data());
}

/// Of all clouds, through the core alone.
const std::vector<PipelineResult>& coreResults() {
  static const std::vector<PipelineResult> made = [] {
    Pipeline pipeline(Config{});
    std::vector<PipelineResult> results;
    for (const auto& cloud : walk().clouds) results.push_back(pipeline.process(viewOf(cloud)));
    return results;
  }();
  return made;
}

void expectCovariance(const Row6& covariance) {
  EXPECT_LE((covariance - covariance.transpose()).norm(), 1e-9 * covariance.norm());
  const Vector6 eigenvalues = eigenOf(covariance).values;
  EXPECT_GT(eigenvalues.minCoeff(), 0.0);
  EXPECT_LT(eigenvalues.maxCoeff(), 0.01);  // (10 cm)^2
}

TEST_F(MapperTest, OdometryIsThePoseOfTheCore) {
  start();
  map(scans());
  ASSERT_TRUE(odometry_.waitFor(scans().size()));
  const auto messages = odometry_.messages();
  for (size_t i = 0; i < scans().size(); ++i) {
    const nav_msgs::Odometry& odometry = *messages[i];
    const ScanResult& core = coreResults()[i].scan;
    ASSERT_TRUE(core.located());
    EXPECT_TRUE(same(core.T_map_sensor, odometry.pose.pose)) << i;
    EXPECT_TRUE(core.covariance == matrixOf(odometry.pose.covariance)) << i;
    EXPECT_EQ(scans()[i].header.stamp, odometry.header.stamp);
    EXPECT_EQ("map", odometry.header.frame_id);
    EXPECT_EQ("lidar", odometry.child_frame_id);
  }
}

TEST_F(MapperTest, CovarianceAndVelocityFollowTheWalk) {
  start();
  map(scans());
  ASSERT_TRUE(odometry_.waitFor(scans().size()));
  const auto messages = odometry_.messages();
  std::vector<double> sizes;
  for (size_t i = 1; i < scans().size(); ++i) {  // the first is where the map begins
    const Row6 covariance = matrixOf(messages[i]->pose.covariance);
    expectCovariance(covariance);
    sizes.push_back(covariance.trace());
  }
  const auto [least, largest] = std::minmax_element(sizes.begin(), sizes.end());
  EXPECT_GT(*largest, 1.01 * *least);
  for (size_t i = kScans - 5; i < kScans; ++i) {
    const double seconds = walk().truth[i].stamp - walk().truth[i - 1].stamp;
    const Twist truth = twistOf(walk().truth[i - 1].pose.inverse() * walk().truth[i].pose, seconds);
    const auto& twist = messages[i]->twist.twist;
    const Eigen::Vector3d linear(twist.linear.x, twist.linear.y, twist.linear.z);
    const Eigen::Vector3d angular(twist.angular.x, twist.angular.y, twist.angular.z);
    ASSERT_GT(truth.linear.norm(), 0.5);
    EXPECT_LT((linear - truth.linear).norm(), 0.3) << i;
    EXPECT_LT((angular - truth.angular).norm(), 0.1) << i;
    const Row6 covariance = matrixOf(messages[i]->twist.covariance);
    EXPECT_GT(covariance.diagonal().minCoeff(), 0.0);
  }
}

TEST_F(MapperTest, TfHasEveryScanWithItsStamp) {
  start();
  map(firstScans(1));  // TF does not know the sensor's frame, which takes a while to find out
  const ros::WallTime first = ros::WallTime::now();
  EXPECT_TRUE(transformsTo("lidar").empty());
  EXPECT_TRUE(eventually([&] { return ros::WallTime::now() > first + ros::WallDuration(0.35); }));
  map({scans().begin() + 1, scans().end()});
  const Transforms transforms = transformsTo("lidar");
  ASSERT_EQ(scans().size(), transforms.size());
  for (size_t i = 0; i < scans().size(); ++i) {
    EXPECT_EQ(scans()[i].header.stamp, transforms[i].header.stamp);
    EXPECT_TRUE(same(coreResults()[i].scan.T_map_sensor, transforms[i].transform)) << i;
  }
}

TEST_F(MapperTest, PublishesNoTfIfToldSo) {
  setParameter("mapper", "publish_tf", false);
  publishStatic({transformOf("base_link", "lidar", ros::Time(1), Pose::Identity())});
  start();
  map(scans());
  expectOdometry(walkPoses());
  EXPECT_TRUE(transformsTo("base_link").empty());
  EXPECT_TRUE(transformsTo("lidar").empty());
}

TEST_F(MapperTest, ReportsEveryScan) {
  start();
  Scans sent = scans();
  for (size_t i = 0; i < sent.size(); ++i) {
    sent[i].number = 100 + i;
    sent[i].arrival = ros::Time(ros::WallTime::now().toSec() - 60.0);
    sent[i].voxelize_seconds = 0.5F;
    sent[i].extract_seconds = 0.25F;
    sent[i].refused = 3;
    sent[i].dropped = 4;
  }
  map(sent);
  const auto reports = reports_.messages();
  for (size_t i = 0; i < sent.size(); ++i) {
    const ScanReport& report = *reports[i];
    const PipelineResult& core = coreResults()[i];
    EXPECT_EQ(sent[i].header.stamp, report.header.stamp);
    EXPECT_EQ("lidar", report.header.frame_id);
    EXPECT_EQ(100 + i, report.number);
    EXPECT_TRUE(report.located);
    EXPECT_EQ(toString(core.scan.status), report.status);
    EXPECT_EQ("", report.text);
    EXPECT_EQ(static_cast<float>(core.scan.hit_ratio), report.hit_ratio);
    EXPECT_EQ(static_cast<float>(core.scan.required_hit_ratio), report.required_hit_ratio);
    EXPECT_EQ(static_cast<float>(core.scan.blocked), report.blocked);
    EXPECT_EQ(static_cast<float>(core.scan.most_blocked), report.most_blocked);
    EXPECT_EQ(core.scan.matches, report.matches);
    EXPECT_EQ(core.scan.restarts, report.restarts);
    EXPECT_EQ(core.points, report.points);
    EXPECT_EQ(core.scan_voxels, report.voxels);
    EXPECT_EQ(core.edges->edges, report.edge_voxels);
    EXPECT_NEAR(70.0, report.latency, 10.5);  // of the cloud, not of the scan
    EXPECT_EQ(0.5F, report.voxelize);
    EXPECT_EQ(0.25F, report.extract);
    EXPECT_GT(report.insert, 0.0F);
    EXPECT_EQ(i > 0, report.match > 0.001F);
    EXPECT_EQ(3U, report.refused);
    EXPECT_EQ(4U, report.dropped);
  }
  EXPECT_EQ("first", reports.front()->status);
  EXPECT_EQ("tracked", reports.back()->status);
  EXPECT_TRUE(tells("mapper", [&](const Status& s) {
    return valueOf(s, "scans") == std::to_string(kScans) && valueOf(s, "scans first") == "1" &&
           valueOf(s, "clouds refused before") == "3" && valueOf(s, "scans dropped in all") == "4";
  }));
  EXPECT_TRUE(tells("mapper", Status::WARN, {"poses come late"}));
}

TEST_F(MapperTest, TakesScansStraightFromTheVoxelizer) {
  start();
  Scans sent = scans();
  for (VoxelScanStamped& scan : sent) {
    scan.occupied_voxels = scan.edge_voxels = scan.sparse_voxels = 0;
    for (Voxel& voxel : scan.voxels) voxel.edge = 0;
  }
  map(sent);
  expectOdometry(walkPoses());
  EXPECT_EQ(0U, reports_.messages().back()->edge_voxels);
  EXPECT_EQ(0.0F, reports_.messages().back()->extract);
}

/// What is left of the poses with at least 5 cm between them, but for the oldest.
std::vector<nav_msgs::Odometry> thinned(const std::vector<nav_msgs::Odometry::ConstPtr>& all,
                                        size_t most) {
  std::vector<nav_msgs::Odometry> kept;
  const auto at = [](const nav_msgs::Odometry& o) {
    const auto& p = o.pose.pose.position;
    return Eigen::Vector3d(p.x, p.y, p.z);
  };
  for (const auto& odometry : all) {
    if (kept.empty() || (at(*odometry) - at(kept.back())).norm() >= 0.05) kept.push_back(*odometry);
  }
  if (kept.size() > most) kept.erase(kept.begin(), kept.end() - static_cast<std::ptrdiff_t>(most));
  return kept;
}

TEST_F(MapperTest, PathIsBoundedAndWaitsForLateListeners) {
  constexpr size_t kLongest = 6;
  setParameter("mapper", "path_length", static_cast<int>(kLongest));
  setParameter("mapper", "map_period", 0.1);
  start();
  map(scans());
  const auto expected = thinned(odometry_.messages(), kLongest);
  ASSERT_EQ(kLongest, expected.size());
  for (int listener = 0; listener < 2; ++listener) {
    const Listener<nav_msgs::Path> late(resolved("path"));
    ASSERT_TRUE(late.waitFor(1)) << listener;
    const nav_msgs::Path path = *late.messages().back();
    EXPECT_EQ("map", path.header.frame_id);
    EXPECT_EQ(expected.back().header.stamp, path.header.stamp);
    ASSERT_EQ(expected.size(), path.poses.size());
    for (size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(expected[i].header.stamp, path.poses[i].header.stamp);
      EXPECT_EQ("map", path.poses[i].header.frame_id);
      EXPECT_EQ(expected[i].pose.pose, path.poses[i].pose);
    }
  }
}

}  // namespace
}  // namespace edgevox::test

int main(int argc, char** argv) { return edgevox::test::runNodeletTests(argc, argv); }
