// SPDX-License-Identifier: BSD-3-Clause
// edgevox/Mapper with an odometry frame: predictions from TF, and map -> odom on TF.
#include <std_srvs/Trigger.h>
#include <tf2/buffer_core.h>

#include "ros/conversions/pose_messages.hpp"
#include "ros/conversions/scan_transforms.hpp"
#include "ros/mapper_fixture.hpp"
#include "support/sweeps.hpp"

namespace edgevox::test {
namespace {

Pose baseLidar() {
  Pose pose(Eigen::AngleAxisd(0.2, Eigen::Vector3d(0, 1, 0)));
  pose.translation() = Eigen::Vector3d(0.3, 0.1, 0.9);
  return pose;
}

Transforms mounting() { return {transformOf("base_link", "lidar", ros::Time(0), baseLidar())}; }

/// A wheel odometry that begins anywhere and counts a tenth too much.
geometry_msgs::TransformStamped odometryOf(size_t scan) {
  Pose start(Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ()));
  start.translation() = Eigen::Vector3d(30, -20, 1);
  Pose step = walk().truth[0].pose.inverse() * walk().truth[scan].pose;
  step.translation() *= 1.1;
  return transformOf("odom", "base_link", scans()[scan].header.stamp,
                     start * step * baseLidar().inverse());
}

/// What TF says about the scans if it holds the odometry of the first `known`.
std::vector<ScanTransforms> transformsOf(const Scans& scans, size_t known) {
  tf2::BufferCore buffer(ros::Duration(100));
  for (const auto& transform : mounting()) buffer.setTransform(transform, "test", true);
  for (size_t i = 0; i < known; ++i) buffer.setTransform(odometryOf(i), "test");
  ScanTransformer transformer(SensorFrames(buffer, {"base_link", "odom"}));
  std::vector<ScanTransforms> all;
  for (const VoxelScanStamped& scan : scans) {
    all.push_back(std::get<ScanTransforms>(transformer.transformsOf(scan.header)));
  }
  return all;
}

std::vector<ScanResult> mappedWith(const Scans& scans,
                                   const std::vector<ScanTransforms>& transforms) {
  std::vector<ScanPrior> priors;
  for (const ScanTransforms& one : transforms) priors.push_back(one.prior());
  return mapped(scans, priors);
}

std::vector<Pose> basePoses(const std::vector<ScanResult>& results,
                            const std::vector<ScanTransforms>& transforms) {
  std::vector<Pose> poses;
  for (size_t i = 0; i < results.size(); ++i) {
    if (!results[i].located()) continue;
    poses.push_back(results[i].T_map_sensor * transforms[i].T_base_sensor.inverse());
  }
  return poses;
}

class OdometryTest : public MapperTest {
 protected:
  void startWithOdometry(double transform_wait) {
    publishStatic(mounting());
    setParameter("mapper", "odom_frame", "odom");
    setParameter("mapper", "base_frame", "base_link");
    setParameter("mapper", "transform_wait", transform_wait);
    start();
  }

  /// Several are waited for: tf2 gives the last transform that it has to the bit, but one that has
  /// another behind it by an interpolation that may round.
  void publishOdometry(size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) publishTf({odometryOf(i)});
    if (end - first > 1) ros::WallDuration(0.3).sleep();
  }

  /// map -> odom must be this, with the scan's stamp.
  void expectMapToOdom(const ScanResult& result, const ScanTransforms& transforms,
                       const ros::Time& stamp, const geometry_msgs::TransformStamped& actual) {
    EXPECT_EQ(stamp, actual.header.stamp);
    EXPECT_TRUE(same(result.T_map_sensor * transforms.T_odom_sensor->inverse(), actual.transform));
  }
};

TEST_F(OdometryTest, PredictsAndCorrectsIt) {
  startWithOdometry(5.0);
  publishOdometry(0, kScans);
  map(scans());
  const auto transforms = transformsOf(scans(), kScans);
  const auto results = mappedWith(scans(), transforms);
  const auto poses = basePoses(results, transforms);
  ASSERT_EQ(scans().size(), poses.size());
  expectOdometry(poses);
  const Transforms tf = transformsTo("odom");
  ASSERT_EQ(scans().size(), tf.size());
  for (size_t i = 0; i < tf.size(); ++i) {
    expectMapToOdom(results[i], transforms[i], scans()[i].header.stamp, tf[i]);
  }
  EXPECT_TRUE(transformsTo("base_link").empty());
  EXPECT_TRUE(transformsTo("lidar").empty());
  EXPECT_EQ("base_link", odometry_.messages().back()->child_frame_id);

  const PoseDifference start = differenceOf(Pose::Identity(), poseOf(tf.front().transform));
  EXPECT_LT(start.metres + start.degrees, 1e-6);
  EXPECT_GT(differenceOf(Pose::Identity(), poseOf(tf.back().transform)).metres, 0.03);
  const auto without = mappedWith(scans(), transformsOf(scans(), 1));
  EXPECT_FALSE(sameBits(without.back().T_map_sensor, results.back().T_map_sensor));
}

TEST_F(OdometryTest, ThatComesLateIsWaitedFor) {
  startWithOdometry(10.0);
  const ros::WallDuration late(0.1);
  const Scans sent = firstScans(5);
  for (size_t i = 0; i < sent.size(); ++i) {
    send(sent[i]);
    late.sleep();
    EXPECT_EQ(i, reports_.count());
    publishOdometry(i, i + 1);
    ASSERT_TRUE(allReported());
  }
  const auto transforms = transformsOf(sent, sent.size());
  expectOdometry(basePoses(mappedWith(sent, transforms), transforms));
}

TEST_F(OdometryTest, ThatNeverComesIsAWarning) {
  startWithOdometry(0.02);
  const Scans sent = firstScans(4);
  map(sent);
  for (size_t i = 0; i < sent.size(); ++i) EXPECT_NE("no_mounting", statusOf(i));
  const auto transforms = transformsOf(sent, 0);
  expectOdometry(basePoses(mappedWith(sent, transforms), transforms));
  EXPECT_TRUE(transformsTo("odom").empty());
  EXPECT_TRUE(logs(rosgraph_msgs::Log::WARN,
                   {resolved("mapper"), "constant velocity", "'lidar' to 'odom'"}));
  EXPECT_TRUE(tells("mapper", [](const Status& s) {
    return s.level >= Status::WARN && hasWords(s.message, {"constant velocity", "'odom'"});
  }));
}

TEST_F(OdometryTest, OfOneScanMayBeMissing) {
  startWithOdometry(2.0);
  publishOdometry(0, kMiddle);
  map(firstScans(kMiddle));
  map({scans()[kMiddle]});
  EXPECT_TRUE(tells("mapper", Status::WARN, {"constant velocity", "'odom'"}));
  publishOdometry(kMiddle + 1, kScans);
  map({scans().begin() + kMiddle + 1, scans().end()});
  auto transforms = transformsOf(scans(), kScans);
  transforms[kMiddle].T_odom_sensor.reset();
  const auto results = mappedWith(scans(), transforms);
  expectOdometry(basePoses(results, transforms));
  const Transforms tf = transformsTo("odom");
  ASSERT_EQ(scans().size(), tf.size());
  EXPECT_EQ(scans()[kMiddle].header.stamp, tf[kMiddle].header.stamp);
  EXPECT_EQ(tf[kMiddle - 1].transform, tf[kMiddle].transform);
  expectMapToOdom(results.back(), transforms.back(), scans().back().header.stamp, tf.back());
  EXPECT_TRUE(tells("mapper", Status::OK, {"tracked"})) << "it is there again";
}

TEST_F(OdometryTest, StaysCorrectedAsBeforeWhenAScanIsLost) {
  startWithOdometry(5.0);
  publishOdometry(0, kScans);
  Scans sent = scans();
  sent[kMiddle] = randomScan(sent[kMiddle].header.stamp);
  sent[kMiddle + 1].voxels.resize(10);
  map(sent);
  EXPECT_EQ("lost", statusOf(kMiddle));
  EXPECT_EQ("too_few", statusOf(kMiddle + 1));
  const auto transforms = transformsOf(sent, kScans);
  const auto results = mappedWith(sent, transforms);
  expectOdometry(basePoses(results, transforms));
  const Transforms tf = transformsTo("odom");
  ASSERT_EQ(sent.size(), tf.size());
  for (const size_t unlocated : {kMiddle, kMiddle + 1}) {
    EXPECT_EQ(sent[unlocated].header.stamp, tf[unlocated].header.stamp);
    EXPECT_EQ(tf[kMiddle - 1].transform, tf[unlocated].transform);
  }
  expectMapToOdom(results.back(), transforms.back(), sent.back().header.stamp, tf.back());
}

TEST_F(OdometryTest, ThatJumpsIsBridgedAndTold) {
  startWithOdometry(5.0);
  Pose jump(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()));
  jump.translation() = Eigen::Vector3d(500e3, 5000e3, 30);
  for (size_t i = 0; i < kScans; ++i) {
    auto odometry = odometryOf(i);
    if (i >= kMiddle) {
      odometry = transformOf("odom", "base_link", odometry.header.stamp,
                             jump * poseOf(odometry.transform));
    }
    publishTf({odometry});
  }
  ros::WallDuration(0.3).sleep();
  map(scans());
  const auto reports = reports_.messages();
  for (size_t i = 0; i < reports.size(); ++i) {
    EXPECT_TRUE(reports[i]->located) << i;
    EXPECT_EQ(i == kMiddle, reports[i]->odometry_jumped != 0) << i;
  }
  EXPECT_TRUE(logs(rosgraph_msgs::Log::WARN, {"its odometry has jumped", "odom_frame"}));
  EXPECT_TRUE(
      tells("mapper", [](const Status& s) { return valueOf(s, "jumps of the odometry") == "1"; }));
  const Transforms tf = transformsTo("odom");
  ASSERT_EQ(scans().size(), tf.size());
  const auto transforms = transformsOf(scans(), kScans);
  const auto expected = basePoses(mappedWith(scans(), transforms), transforms);
  const Pose T_odom_base = jump * poseOf(odometryOf(kScans - 1).transform);
  const PoseDifference error =
      differenceOf(expected.back(), poseOf(tf.back().transform) * T_odom_base);
  EXPECT_LT(error.metres, 0.01);
}

TEST_F(OdometryTest, BeginsAnewAfterAReset) {
  startWithOdometry(5.0);
  publishOdometry(0, kScans);
  map(firstScans(kMiddle));
  call<std_srvs::Trigger>("reset");
  VoxelScanStamped few = scans()[kMiddle - 1];
  few.voxels.clear();
  map({few});
  EXPECT_EQ(kMiddle, transformsTo("odom").size());  // the correction is forgotten
  const Scans rest(scans().begin() + kMiddle, scans().end());
  map(rest);
  const auto transforms = transformsOf(scans(), kScans);
  const std::vector<ScanTransforms> later(transforms.begin() + kMiddle, transforms.end());
  auto expected = basePoses(mappedWith(firstScans(kMiddle), transforms), transforms);
  for (const Pose& pose : basePoses(mappedWith(rest, later), later)) expected.push_back(pose);
  expectOdometry(expected);
  const Transforms tf = transformsTo("odom");
  ASSERT_EQ(scans().size(), tf.size());
  const PoseDifference start = differenceOf(Pose::Identity(), poseOf(tf[kMiddle].transform));
  EXPECT_LT(start.metres + start.degrees, 1e-6);
}

}  // namespace
}  // namespace edgevox::test

int main(int argc, char** argv) { return edgevox::test::runNodeletTests(argc, argv); }
