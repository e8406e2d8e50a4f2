// SPDX-License-Identifier: BSD-3-Clause
// edgevox/Mapper without odometry: the base frame, and what TF may hold instead of what it should.
#include <tf2/buffer_core.h>

#include "ros/conversions/pose_messages.hpp"
#include "ros/mapper_fixture.hpp"
#include "support/sweeps.hpp"

namespace edgevox::test {
namespace {

Pose makePose(const Eigen::Vector3d& translation, double angle, const Eigen::Vector3d& axis) {
  Pose pose(Eigen::AngleAxisd(angle, axis.normalized()));
  pose.translation() = translation;
  return pose;
}

geometry_msgs::TransformStamped staticTransform(const std::string& parent, const std::string& child,
                                                const Pose& pose = Pose::Identity()) {
  return transformOf(parent, child, ros::Time(0), pose);
}

const Pose kRootBase = makePose({0, 0, 0.3}, 0.1, {0, 1, 0});
const Pose kBaseLidar = makePose({0.4, -0.2, 1.1}, 0.5, {1, 2, 3});  // tilted

Transforms robot() {
  return {staticTransform("base_footprint", "base_link", kRootBase),
          staticTransform("base_link", "lidar", kBaseLidar)};
}

/// The mounting as TF gives it.
Pose mounting() {
  tf2::BufferCore buffer;
  for (const auto& transform : robot()) buffer.setTransform(transform, "test", true);
  return poseOf(buffer.lookupTransform("base_link", "lidar", ros::Time(0)).transform);
}

/// Of the walk with the map's frame where the base is at first.
const std::vector<ScanResult>& mountedResults() {
  static const std::vector<ScanResult> made =
      mapped(scans(), std::vector<ScanPrior>(scans().size(), {std::nullopt, mounting()}));
  return made;
}

std::vector<Pose> basePoses(size_t count = scans().size()) {
  std::vector<Pose> poses = posesOf(mountedResults());
  poses.resize(count);
  for (Pose& pose : poses) pose = pose * mounting().inverse();
  return poses;
}

class FramesTest : public MapperTest {
 protected:
  void startWithBase(double transform_wait) {
    setParameter("mapper", "base_frame", "base_link");
    setParameter("mapper", "transform_wait", transform_wait);
    start();
  }

  void expectReport(size_t number, const std::string& status,
                    const std::vector<std::string>& words) {
    const ScanReport report = *reports_.messages().at(number);
    EXPECT_EQ(status, report.status);
    EXPECT_FALSE(report.located);
    EXPECT_TRUE(hasWords(report.text, words)) << report.text;
  }
};

TEST_F(FramesTest, WithABaseItsPoseGoesOut) {
  publishStatic(robot());
  startWithBase(5.0);
  map(scans());
  ASSERT_TRUE(posesOf(mountedResults()).size() == scans().size());
  expectOdometry(basePoses());
  const PoseDifference start = differenceOf(Pose::Identity(), basePoses().front());
  EXPECT_LT(start.metres + start.degrees, 1e-9);
  const Pose T_start_base =
      walk().truth[0].pose * kBaseLidar.inverse();  // the truth is the sensor's
  const Pose moved = T_start_base.inverse() * (walk().truth.back().pose * kBaseLidar.inverse());
  EXPECT_GT(moved.translation().norm(), 0.5);
  EXPECT_LT(differenceOf(moved, basePoses().back()).metres, 0.05);
  for (const auto& odometry : odometry_.messages()) {
    EXPECT_EQ("map", odometry->header.frame_id);
    EXPECT_EQ("base_link", odometry->child_frame_id);
  }
}

TEST_F(FramesTest, TfJoinsTheMapToTheRootOfTheRobot) {
  publishStatic(robot());
  startWithBase(5.0);
  map(scans());
  const Transforms transforms = transformsTo("base_footprint");
  ASSERT_EQ(scans().size(), transforms.size());
  for (size_t i = 0; i < transforms.size(); ++i) {
    EXPECT_EQ(scans()[i].header.stamp, transforms[i].header.stamp);
    const Pose T_map_base = poseOf(transforms[i].transform) * kRootBase;
    const PoseDifference error = differenceOf(basePoses()[i], T_map_base);
    EXPECT_LT(error.metres + error.degrees, 1e-5) << i;
  }
  EXPECT_TRUE(transformsTo("base_link").empty());
  EXPECT_TRUE(transformsTo("lidar").empty());
}

/// A pose moved by a small translation and rotation in the map's axes, about its own origin.
Pose nudged(const Pose& pose, const Eigen::Matrix<double, 6, 1>& by) {
  Pose result = pose;
  result.translation() += by.head<3>();
  result.linear() = rotationOf(by.tail<3>()) * pose.linear();
  return result;
}

Matrix6 covarianceOfTheBase(const ScanResult& scan) {
  constexpr double kStep = 1e-6;
  const Pose T_sensor_base = kBaseLidar.inverse();
  const Pose T_map_base = scan.T_map_sensor * T_sensor_base;
  Matrix6 change;
  for (int axis = 0; axis < 6; ++axis) {
    const Pose moved =
        nudged(scan.T_map_sensor, kStep * Eigen::Matrix<double, 6, 1>::Unit(axis)) * T_sensor_base;
    change.col(axis) << (moved.translation() - T_map_base.translation()) / kStep,
        rotationVector(moved.linear() * T_map_base.linear().transpose()) / kStep;
  }
  return change * scan.covariance * change.transpose();
}

TEST_F(FramesTest, CovarianceIsThatOfTheBase) {
  publishStatic(robot());
  startWithBase(5.0);
  map(scans());
  ASSERT_TRUE(odometry_.waitFor(scans().size()));
  for (size_t i = 1; i < scans().size(); ++i) {
    const auto message = odometry_.messages()[i];
    const auto& values = message->pose.covariance;
    const Matrix6 actual =
        Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(values.data());
    const Matrix6 expected = covarianceOfTheBase(mountedResults()[i]);
    EXPECT_LT((actual - expected).norm(), 1e-4 * expected.norm()) << i;
    EXPECT_GT((actual - mountedResults()[i].covariance).norm(), 0.01 * expected.norm());
  }
}

TEST_F(FramesTest, WithoutAMountingScansAreLeftOut) {
  startWithBase(0.02);
  map(firstScans(3));
  for (size_t i = 0; i < 3; ++i) {
    expectReport(i, "no_mounting", {"'lidar' to 'base_link'", "check the frame's name"});
  }
  EXPECT_TRUE(tells("mapper", Status::ERROR, {"no_mounting for 3 scans", "'base_link'"}));
  publishStatic(robot());
  EXPECT_TRUE(eventually([&] {  // until the nodelet has got it
    map({scans()[0]});
    return lastStatus() != "no_mounting";
  }));
  map({scans().begin() + 1, scans().end()});
  expectOdometry(basePoses());
  EXPECT_TRUE(tells("mapper", Status::OK, {"tracked"}));
}

TEST_F(FramesTest, AMountingThatComesLateIsWaitedFor) {
  startWithBase(5.0);
  for (const VoxelScanStamped& scan : scans()) send(scan);
  publishStatic(robot());
  ASSERT_TRUE(allReported());
  expectOdometry(basePoses());
}

TEST_F(FramesTest, CanBeUnloadedWhileItWaits) {
  startWithBase(10.0);  // the longest there is
  send(scans()[0]);
  send(scans()[1]);
  ASSERT_TRUE(tells("mapper", [](const Status& s) { return valueOf(s, "received") == "2"; }));
  const ros::WallTime begin = ros::WallTime::now();
  EXPECT_TRUE(unload("mapper"));
  EXPECT_LT((ros::WallTime::now() - begin).toSec(), 5.0);
  EXPECT_EQ(0U, reports_.count());
}

TEST_F(FramesTest, AnotherSensorInTheMiddleIsLeftOut) {
  start();
  Scans sent;
  for (const VoxelScanStamped& scan : scans()) {
    sent.push_back(scan);
    if (sent.size() % 4 != 0) continue;
    sent.push_back(randomScan(scan.header.stamp + ros::Duration(0.08)));
    sent.back().header.frame_id = "rear_lidar";
  }
  map(sent);
  expectOdometry(walkPoses());
  expectReport(4, "other_frame", {"'rear_lidar'", "'lidar'", "a topic of their own"});
  EXPECT_TRUE(logs(rosgraph_msgs::Log::WARN, {resolved("mapper"), "other_frame", "rear_lidar"}));
}

TEST_F(FramesTest, AFrameWithAnotherParentIsLeftAlone) {
  publishStatic({staticTransform("earth", "odom"), staticTransform("odom", "lidar")});
  setParameter("mapper", "odom_frame", "odom");
  setParameter("mapper", "transform_wait", 5.0);
  start();
  map(scans());
  EXPECT_TRUE(tells("mapper", Status::ERROR,
                    {"no pose on TF", "'odom' already has the parent 'earth'", "stop the other"}));
  EXPECT_TRUE(transformsTo("odom").empty());
  EXPECT_TRUE(odometry_.waitFor(scans().size()));
}

/// A frame that gets another parent after the map is its parent.
class NewParentTest : public FramesTest {
 protected:
  /// `publish` makes it the child of base_link.
  void expectLeftAlone(const std::function<void()>& publish);
};

void NewParentTest::expectLeftAlone(const std::function<void()>& publish) {
  start();
  double seconds = 0.0;  // of the first scan, again and again
  EXPECT_TRUE(eventually([&] {
    map({shifted(0, seconds += 0.1)});
    return !transformsTo("lidar").empty();
  }));
  publish();
  const std::string error = "'lidar' already has the parent 'base_link'";
  EXPECT_TRUE(eventually([&] {
    map({shifted(0, seconds += 0.1)});
    return countLogged(rosgraph_msgs::Log::WARN, {resolved("mapper"), error}) > 0;
  }));
  const size_t published = transformsTo("lidar").size();
  map({shifted(0, seconds += 0.1)});
  EXPECT_EQ(published, transformsTo("lidar").size());
  EXPECT_TRUE(tells("mapper", Status::ERROR, {error}));
}

TEST_F(NewParentTest, OnTfKeepsIt) {
  expectLeftAlone([&] {
    publishTf({transformOf("base_link", "lidar", stampAfter(0, 1000.0), Pose::Identity())});
  });
}

TEST_F(NewParentTest, OnStaticTfKeepsIt) {
  expectLeftAlone([&] { publishStatic({staticTransform("base_link", "lidar")}); });
}

TEST_F(FramesTest, TheMapFrameOfAnotherNodeIsLeftAlone) {
  publishStatic({staticTransform("map", "base_link"), staticTransform("base_link", "lidar")});
  startWithBase(5.0);
  map(firstScans(3));
  EXPECT_TRUE(tells("mapper", Status::ERROR, {"'map' is already the root", "another map_frame"}));
  EXPECT_TRUE(transformsTo("base_link").empty());
  EXPECT_TRUE(transformsTo("map").empty());
  EXPECT_TRUE(odometry_.waitFor(3));
}

TEST_F(FramesTest, WithoutAFrameThereIsNoTf) {
  start();
  Scans sent = firstScans(3);
  for (VoxelScanStamped& scan : sent) scan.header.frame_id = "";
  map(sent);
  expectOdometry({walkPoses().begin(), walkPoses().begin() + 3});
  EXPECT_TRUE(tells("mapper", Status::ERROR, {"header.frame_id is empty", "driver"}));
}

TEST_F(FramesTest, ASlashBeforeANameChangesNothing) {
  publishStatic(robot());
  setParameter("mapper", "base_frame", "/base_link");
  setParameter("mapper", "transform_wait", 5.0);
  start();
  Scans sent = scans();
  for (VoxelScanStamped& scan : sent) scan.header.frame_id = "/lidar";
  map(sent);
  expectOdometry(basePoses());
  EXPECT_EQ("base_link", odometry_.messages().back()->child_frame_id);
  EXPECT_EQ(scans().size(), transformsTo("base_footprint").size());
}

}  // namespace
}  // namespace edgevox::test

int main(int argc, char** argv) { return edgevox::test::runNodeletTests(argc, argv); }
