// SPDX-License-Identifier: BSD-3-Clause
// The three nodelets fed with stamps and transforms that nobody can use, between good ones.
#include <functional>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "ros/conversions/checked_transforms.hpp"
#include "ros/conversions/pose_messages.hpp"
#include "ros/conversions/scan_transforms.hpp"
#include "ros/conversions/stamp.hpp"
#include "ros/mapper_fixture.hpp"
#include "ros/simulated_scans.hpp"
#include "support/sweeps.hpp"

namespace edgevox::test {
namespace {

using geometry_msgs::TransformStamped;
using sensor_msgs::PointCloud2;

constexpr uint32_t kLastSecond = std::numeric_limits<uint32_t>::max();
constexpr uint32_t kDay = 86400;  // [s]

std::vector<ros::Time> badStamps(const ros::Time& good) {
  std::vector<ros::Time> stamps(4, good);
  stamps[0] = ros::Time();
  stamps[1].sec = kLastSecond;
  stamps[2].sec = kLastSecond - 28;  // plus the cache of a listener it is past 2^32
  stamps[3].nsec = 1000000000;
  return stamps;
}

TransformStamped mounting() {
  Pose pose(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()));
  pose.translation() = Eigen::Vector3d(0.3, 0.1, 0.9);
  return transformOf("base_link", "lidar", ros::Time(0), pose);
}

/// An odometry that is a little wrong, `seconds` after a scan.
TransformStamped odometryOf(size_t scan, double seconds) {
  Pose step = walk().truth[0].pose.inverse() * walk().truth[scan].pose;
  step.translation() *= 1.1;
  return transformOf("odom", "base_link", stampAfter(scan, seconds), step);
}

using Spoil = std::function<void(TransformStamped&)>;

std::vector<Spoil> spoils() {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  return {[](auto& t) { t.transform.translation.x = kNan; },
          [](auto& t) { t.transform.translation.y = 1e12; },
          [](auto& t) { t.transform.translation.z = -1e80; },
          [](auto& t) { t.transform.translation.x = 1e300; },
          [](auto& t) { t.transform.translation.x = std::numeric_limits<double>::infinity(); },
          [](auto& t) { t.transform.rotation = geometry_msgs::Quaternion(); },
          [](auto& t) { t.transform.rotation.w = 2.0; },
          [](auto& t) { t.transform.rotation.z = kNan; },
          [](auto& t) { t.transform.rotation.z = 1e200; },
          [](auto& t) { t.child_frame_id = ""; },
          [](auto& t) { t.header.frame_id = "/"; },
          [](auto& t) { t.header.frame_id = t.child_frame_id; },
          [](auto& t) { t.header.stamp.sec = kLastSecond; },
          [](auto& t) { t.header.stamp.sec = kLastSecond - 28; },
          [](auto& t) { t.header.stamp.nsec = kLastSecond; }};
}

Transforms spoilt(const TransformStamped& good) {
  Transforms bad;
  for (const Spoil& spoil : spoils()) {
    bad.push_back(good);
    spoil(bad.back());
  }
  return bad;
}

/// What the core makes of the walk, with these transforms of the base.
std::vector<ScanTransforms> transformsOf(const Transforms& odometry) {
  CheckedTransforms checked(ros::Duration(100), Config{}.mapper.clock_leap);
  EXPECT_FALSE(checked.add(mounting(), "test", true));
  for (const auto& transform : odometry) EXPECT_FALSE(checked.add(transform, "test", false));
  ScanTransformer transformer(SensorFrames(checked.buffer(), {"base_link", "odom"}));
  std::vector<ScanTransforms> all;
  for (const auto& scan : scans()) {
    all.push_back(std::get<ScanTransforms>(transformer.transformsOf(scan.header)));
    EXPECT_TRUE(all.back().T_odom_sensor) << all.back().odometry_error;
  }
  return all;
}

std::vector<ScanResult> mappedWith(const std::vector<ScanTransforms>& transforms) {
  std::vector<ScanPrior> priors;
  for (const ScanTransforms& one : transforms) priors.push_back(one.prior());
  return mapped(scans(), priors);
}

std::vector<Pose> basePoses(const std::vector<ScanResult>& results) {
  std::vector<Pose> poses = posesOf(results);
  for (Pose& pose : poses) pose = pose * poseOf(mounting().transform).inverse();
  return poses;
}

/// Before and after each scan.
Transforms goodOdometry() {
  Transforms all;
  for (size_t i = 0; i < scans().size(); ++i) {
    all.push_back(odometryOf(i, -0.03));
    all.push_back(odometryOf(i, 0.03));
  }
  return all;
}

class GarbageTest : public MapperTest {
 protected:
  void startAll(bool publish_tf) {
    publishStatic({mounting()});
    setParameter("mapper", "odom_frame", "odom");
    setParameter("mapper", "base_frame", "base_link");
    setParameter("mapper", "publish_tf", publish_tf);
    setParameter("mapper", "transform_wait", 1.0);
    ASSERT_TRUE(load("voxelizer"));
    ASSERT_TRUE(load("edge_extractor"));
    start();
    points_ = advertise<PointCloud2>(resolved("points"), 100);
  }

  /// To each of the nodelets.
  void sendWithStamp(size_t i, const ros::Time& stamp) {
    publishShared(points_, copyOf(stamped(walk().clouds[i], stamp)));
    VoxelScanStamped scan = scans()[i];
    scan.header.stamp = stamp;
    publishShared(voxels_, copyOf(scan));
  }

  /// The cloud and its odometry, which comes before it; waits for its pose.
  void sendGood(size_t i, const std::function<void()>& in_between) {
    publishTf({odometryOf(i, -0.03)});
    in_between();
    publishTf({odometryOf(i, 0.03)});
    publishShared(points_, copyOf(walk().clouds[i]));
    ASSERT_TRUE(odometry_.waitFor(i + 1)) << i;
  }

  void sendGarbage(size_t i) {
    publishTf(spoilt(odometryOf(i, -0.01)));
    publishTf(spoilt(mounting()));
    for (const ros::Time& stamp : badStamps(stampAfter(i, -0.02))) sendWithStamp(i, stamp);
    if (i % 8 != 4) return;
    TransformStamped ahead = odometryOf(i, -0.01);
    ahead.header.stamp.sec += kDay;
    publishTf({ahead});
    VoxelScanStamped scan = scans()[i];
    scan.header.stamp.sec += kDay;
    publishShared(voxels_, copyOf(scan));
  }

  void expectCounts() {
    const size_t bad = 4 * scans().size();
    const auto counted = [](const std::string& key, size_t number) {
      return [=](const Status& s) { return valueOf(s, key) == std::to_string(number); };
    };
    EXPECT_TRUE(tells("voxelizer", counted("refused: bad_stamp", bad)));
    EXPECT_TRUE(tells("edge_extractor", counted("refused: bad_stamp", bad)));
    EXPECT_TRUE(tells("mapper", counted("scans bad_stamp", bad)));
    EXPECT_TRUE(tells("mapper", counted("scans stale", 2)));
    const size_t transforms = 2 * spoils().size() * scans().size() + 2;
    EXPECT_TRUE(tells("mapper", counted("transforms refused", transforms)));
  }

  /// All poses are those of a run without garbage.
  void expectToLeaveNoTrace(bool publish_tf) {
    startAll(publish_tf);
    for (size_t i = 0; i < scans().size(); ++i) {
      sendGood(i, [&] { sendGarbage(i); });
      if (HasFatalFailure()) return;
    }
    const auto transforms = transformsOf(goodOdometry());
    const auto results = mappedWith(transforms);
    ASSERT_EQ(scans().size(), posesOf(results).size());
    expectOdometry(basePoses(results));
    const Transforms tf = transformsTo("odom");
    ASSERT_EQ(publish_tf ? scans().size() : 0U, tf.size());
    for (size_t i = 0; i < tf.size(); ++i) {
      EXPECT_EQ(scans()[i].header.stamp, tf[i].header.stamp);
      EXPECT_TRUE(
          same(results[i].T_map_sensor * transforms[i].T_odom_sensor->inverse(), tf[i].transform));
    }
    for (const auto& report : reports_.messages()) {
      EXPECT_TRUE(report->header.stamp.isZero() || !faultOf(report->header.stamp));
    }
    expectCounts();
  }

  ros::Publisher points_;
};

TEST_F(GarbageTest, LeavesNoTraceInThePoses) { expectToLeaveNoTrace(true); }

TEST_F(GarbageTest, LeavesNoTraceWithoutPublishTf) { expectToLeaveNoTrace(false); }

TEST_F(GarbageTest, IsNamedAndWhatIsRefusedIsTold) {
  startAll(true);
  sendGood(0, [&] { publishTf(spoilt(odometryOf(0, -0.01))); });
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"'odom' to 'base_link'", "component of nan"},
                                             {"quaternion is of norm 0, not of 1"},
                                             {"a frame has no name"},
                                             {"its two frames are one"},
                                             {"4294967295 s", "correct what publishes it"}}) {
    EXPECT_TRUE(logs(rosgraph_msgs::Log::WARN, words)) << words.front();
  }
  EXPECT_TRUE(tells("mapper", Status::WARN, {"the transform from", "is refused"}));
  EXPECT_TRUE(eventually([&] { return statusesOf("mapper").back().level == Status::OK; }));
}

TEST_F(GarbageTest, OneOdometryFarAwayIsBridged) {
  TransformStamped far = odometryOf(kMiddle, -0.01);
  far.transform.translation.x = 1e7;
  Transforms odometry = goodOdometry();
  odometry.push_back(far);
  const auto results = mappedWith(transformsOf(odometry));
  startAll(true);
  for (size_t i = 0; i < scans().size(); ++i) {
    Transforms around = {odometryOf(i, -0.03), odometryOf(i, 0.03)};
    if (i == kMiddle) around.insert(around.begin() + 1, far);
    publishTf(around);
    map({scans()[i]});
    EXPECT_EQ(toString(results[i].status), statusOf(i)) << i;
    EXPECT_TRUE(results[i].located()) << i;
    EXPECT_EQ(i == kMiddle || i == kMiddle + 1, results[i].odometry_jumped) << i;
  }
  expectOdometry(basePoses(results));
  const Pose without = posesOf(mappedWith(transformsOf(goodOdometry()))).back();
  EXPECT_LT(differenceOf(without, posesOf(results).back()).metres, 0.01);
}

}  // namespace
}  // namespace edgevox::test

int main(int argc, char** argv) { return edgevox::test::runNodeletTests(argc, argv); }
