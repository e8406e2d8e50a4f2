// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/recording.hpp"

#include <gtest/gtest.h>
#include <rosbag/bag.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/scanner.hpp"
#include "support/temp_folder.hpp"
#include "tools/simulated_bag.hpp"

namespace edgevox {
namespace {

constexpr int kSweeps = 6;

RecordingOptions simulated(const std::string& input, size_t every, size_t most) {
  RecordingOptions options;
  options.input = input;
  options.every = every;
  options.most = most;
  return options;
}

double differenceOf(const Pose& a, const Pose& b) { return (a.matrix() - b.matrix()).norm(); }

/// Distance of the points of a scan, placed by the recording's poses, to the nearest surface.
double meanClearance(const Recording& recording, size_t scan, const sim::World& world) {
  double sum = 0.0;
  const RecordedScan& recorded = recording.scans[scan];
  VoxelScan voxels = Voxelizer({}, 0.1).voxelize(recorded.view);
  for (const ScanVoxel& voxel : voxels.voxels) {
    const Pose pose = recording.poseAt(scan, static_cast<double>(voxel.time_offset));
    sum += std::abs(world.clearance(pose * voxel.centroid.cast<double>(), 1.0));
  }
  return sum / static_cast<double>(voxels.voxels.size());
}

class BagRecordingTest : public ::testing::Test {
 protected:
  BagRecordingTest() {
    run_ = test::simulateRun(kSweeps);
    options_.input = (folder_ / "run.bag").string();
    rosbag::Bag bag(options_.input, rosbag::bagmode::Write);
    test::writeClouds(bag, "/points", run_.clouds);
  }

  test::TempFolder folder_;
  test::SimulatedRun run_;
  RecordingOptions options_;
};

TEST(Recording, SimulatedScansHaveTheirTruePoses) {
  const Recording recording = makeRecording(simulated("building:16:2", 50, 3));
  ASSERT_EQ(recording.scans.size(), 3U);
  ASSERT_TRUE(recording.truth.has_value());
  for (size_t i = 0; i < 3; ++i) {
    const RecordedScan& scan = recording.scans[i];
    EXPECT_NEAR(scan.view.stamp, 5.0 * static_cast<double>(i), 1e-9);
    EXPECT_LT(differenceOf(scan.T_map_sensor, recording.truth->path.poseAt(scan.view.stamp)),
              1e-12);
    EXPECT_EQ(scan.view.data, scan.bytes.data());
    EXPECT_LT(meanClearance(recording, i, recording.truth->world), 0.02);
    EXPECT_EQ(pointsInWorld(recording, i).size(), scan.view.width);
  }
  EXPECT_GT(differenceOf(recording.poseAt(2, 0.09), recording.scans[2].T_map_sensor), 0.01);
}

TEST(Recording, PointsInWorldAreThoseOfTheSimulation) {
  const Recording recording = makeRecording(simulated("corridor:16", 30, 2));
  const SimulatedTruth& truth = *recording.truth;
  const auto scan = sim::simulateSweep(truth.world, truth.path, truth.sensor, 30, 1);
  EXPECT_EQ(pointsInWorld(recording, 1), sim::pointsInWorld(scan, truth.path));
}

TEST(Recording, MoversAreInTheScansAndInTheTruth) {
  const Recording still = makeRecording(simulated("building:16:2", 1, 1));
  const Recording moving = makeRecording(simulated("building+movers:16:2", 1, 1));
  EXPECT_TRUE(still.truth->movers.empty());
  ASSERT_FALSE(moving.truth->movers.empty());
  const sim::World there(sim::solidsAt(moving.truth->movers, 0.05));
  const auto onMovers = [&](const Recording& recording) {
    const auto points = pointsInWorld(recording, 0);
    return std::count_if(points.begin(), points.end(), [&](const Eigen::Vector3d& point) {
      return point.z() > 0.1 && there.clearance(point, 1.0) < 0.05;
    });
  };
  EXPECT_EQ(onMovers(still), 0);
  EXPECT_GT(onMovers(moving), 200);
}

TEST_F(BagRecordingTest, TakesThePosesOfTheFile) {
  const std::string poses = (folder_ / "truth.tum").string();
  writeTum(poses, run_.truth);
  options_.poses = poses;
  options_.every = 2;
  const Recording recording = makeRecording(options_);
  ASSERT_EQ(recording.scans.size(), 3U);
  EXPECT_FALSE(recording.truth.has_value());
  EXPECT_LT(differenceOf(recording.scans[1].T_map_sensor, run_.truth[2].pose), 1e-6);
  // The motion is that to the next cloud of the bag, not to the next one taken.
  EXPECT_LT(differenceOf(recording.poseAt(1, 0.1), run_.truth[3].pose), 1e-5);
  EXPECT_LT(differenceOf(recording.poseAt(1, -0.1), run_.truth[1].pose), 1e-3);
}

TEST_F(BagRecordingTest, BeginsWithTheFirstAskedFor) {
  options_.first = 1;
  options_.every = 3;
  const Recording recording = makeRecording(options_);
  ASSERT_EQ(recording.scans.size(), 2U);
  EXPECT_EQ(recording.scans[0].view.stamp, run_.truth[1].stamp);
  EXPECT_EQ(recording.scans[1].view.stamp, run_.truth[4].stamp);
  options_.first = kSweeps;
  EXPECT_THROW(makeRecording(options_), std::invalid_argument);
}

TEST_F(BagRecordingTest, LeavesOutScansWithoutPose) {
  const std::string poses = (folder_ / "truth.tum").string();
  writeTum(poses, {run_.truth.begin(), run_.truth.begin() + 4});
  options_.poses = poses;
  const Recording recording = makeRecording(options_);
  EXPECT_EQ(recording.scans.size(), 4U);
  EXPECT_EQ(recording.without_pose, 2U);
}

TEST_F(BagRecordingTest, FindsPosesItself) {
  const Recording recording = makeRecording(options_);
  ASSERT_EQ(recording.scans.size(), static_cast<size_t>(kSweeps));
  const Pose found = recording.scans[1].T_map_sensor.inverse() * recording.scans[5].T_map_sensor;
  const Pose truth = run_.truth[1].pose.inverse() * run_.truth[5].pose;
  EXPECT_LT(differenceOf(found, truth), 0.05);
  EXPECT_GT(differenceOf(Pose::Identity(), truth), 0.2);
}

TEST(Recording, RefusesWhatItCannotUse) {
  EXPECT_THROW(makeRecording(simulated("building:17", 1, 1)), std::invalid_argument);
  EXPECT_THROW(makeRecording(simulated("castle:16", 1, 1)), std::invalid_argument);
  EXPECT_THROW(makeRecording(simulated("building:16:x", 1, 1)), std::invalid_argument);
  EXPECT_THROW(makeRecording(simulated("corridor+movers:16", 1, 1)), std::invalid_argument);
  EXPECT_THROW(makeRecording(simulated("building+:16", 1, 1)), std::invalid_argument);
  EXPECT_THROW(makeRecording(simulated("building:16", 0, 1)), std::invalid_argument);
  RecordingOptions with_poses = simulated("building:16", 1, 1);
  with_poses.poses = "some.tum";
  EXPECT_THROW(makeRecording(with_poses), std::invalid_argument);
}

}  // namespace
}  // namespace edgevox
