// SPDX-License-Identifier: BSD-3-Clause
#include "tools/map_bag_run.hpp"

#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <string>
#include <vector>

#include "edgevox/edges/density_monitor.hpp"
#include "edgevox/io/trajectory_io.hpp"
#include "edgevox/scan/motion.hpp"
#include "sim/scanner.hpp"
#include "support/sweeps.hpp"
#include "tools/map_bag_fixture.hpp"
#include "tools/simulated_bag.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;
using sensor_msgs::PointCloud2;
using test::contentOf;
using test::kSweeps;
using test::MapBagTest;
using test::simulatedRun;

size_t linesOf(const fs::path& file) {
  const std::string text = contentOf(file);
  return static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST_F(MapBagTest, mapsASimulatedWalk) {
  writeBag(simulatedRun().clouds);
  writeTum(folder_ / "truth.tum", simulatedRun().truth);
  options_.reference = (folder_ / "truth.tum").string();
  const YAML::Node summary = run();
  EXPECT_EQ(summary["scans"].as<int>(), kSweeps);
  EXPECT_EQ(summary["tracked"].as<int>(), kSweeps);
  EXPECT_EQ(summary["lost"].as<int>(), 0);
  EXPECT_EQ(summary["reference_poses"].as<int>(), kSweeps);
  EXPECT_LT(summary["ape_rmse_m"].as<double>(), 0.03);
  EXPECT_LT(summary["rpe_median_m"].as<double>(), 0.02);
  EXPECT_LT(summary["rpe_median_deg"].as<double>(), 0.3);
  EXPECT_EQ(summary["time_field"].as<std::string>(), "time");
  EXPECT_GT(summary["compression"].as<double>(), 1.0);
  EXPECT_GT(summary["map_bytes"].as<double>(), 0.0);
  EXPECT_GT(summary["peak_rss_mb"].as<double>(), 1.0);
  double stages = 0;
  for (const auto& stage : summary["ms_stages"]) stages += stage.second.as<double>();
  EXPECT_GT(stages, 0.8 * summary["ms_mean"].as<double>());
  EXPECT_LE(stages, 1.01 * summary["ms_mean"].as<double>());
}

TEST_F(MapBagTest, writesWhatItSays) {
  writeBag(simulatedRun().clouds);
  writeTum(folder_ / "truth.tum", simulatedRun().truth);
  options_.reference = (folder_ / "truth.tum").string();
  options_.write_occupied = true;
  const YAML::Node summary = run();
  const Trajectory trajectory = readTum(options_.output / "trajectory.tum");
  ASSERT_EQ(trajectory.size(), size_t{kSweeps});
  EXPECT_TRUE(trajectory.front().pose.isApprox(Pose::Identity()));
  EXPECT_EQ(linesOf(options_.output / "timings.csv"), size_t{kSweeps} + 1);
  EXPECT_EQ(linesOf(options_.output / "errors.csv"), size_t{kSweeps} + 1);
  EXPECT_EQ(contentOf(options_.output / "timings.csv")
                .find("scan,stamp,status,hit_ratio,points,voxels,voxelize_ms,extract_ms,match_ms,"
                      "insert_ms,label_ms,total_ms,latency_ms\n0,"),
            0U);
  EXPECT_EQ(contentOf(options_.output / "errors.csv").find("stamp,ape_m,rpe_m,rpe_deg,moving\n"),
            0U);

  pcl::PointCloud<pcl::PointXYZ> ply, pcd, occupied;
  ASSERT_EQ(pcl::io::loadPLYFile((options_.output / "map_edges.ply").string(), ply), 0);
  ASSERT_EQ(pcl::io::loadPCDFile((options_.output / "map_edges.pcd").string(), pcd), 0);
  ASSERT_EQ(pcl::io::loadPLYFile((options_.output / "map_occupied.ply").string(), occupied), 0);
  EXPECT_EQ(ply.size(), summary["edge_voxels"].as<size_t>());
  EXPECT_EQ(occupied.size(), summary["occupied_voxels"].as<size_t>());
  ASSERT_EQ(pcd.size(), ply.size());
  for (size_t i = 0; i < ply.size(); ++i) {
    ASSERT_EQ(ply.points[i].getVector3fMap(), pcd.points[i].getVector3fMap());
  }
}

TEST_F(MapBagTest, saysOnceThatVoxelsAreTooSmall) {
  writeBag({simulatedRun().clouds.begin(), simulatedRun().clouds.begin() + 4});
  EXPECT_LT(run()["sparse_share"].as<double>(), kSparseLimit);
  EXPECT_FALSE(logged("too sparse"));
  options_.settings = {"voxel_size=0.02"};
  EXPECT_GT(run()["sparse_share"].as<double>(), kSparseLimit);
  const std::string log = log_.str();
  const size_t first = log.find("stand alone; choose voxel_size ");
  ASSERT_NE(first, std::string::npos) << log;
  EXPECT_EQ(log.find("too sparse", first), std::string::npos) << log;
}

TEST_F(MapBagTest, nothingOfAnEarlierRunIsLeft) {
  writeBag({simulatedRun().clouds.begin(), simulatedRun().clouds.begin() + 3});
  writeTum(folder_ / "truth.tum", simulatedRun().truth);
  MapBagOptions first = options_;
  first.reference = (folder_ / "truth.tum").string();
  first.write_occupied = true;
  run(first);
  EXPECT_TRUE(fs::exists(options_.output / "errors.csv"));
  run();
  EXPECT_FALSE(fs::exists(options_.output / "errors.csv"));
  EXPECT_FALSE(fs::exists(options_.output / "map_occupied.ply"));
}

TEST_F(MapBagTest, sameBytesForAnyNumberOfThreads) {
  writeBag(simulatedRun().clouds);
  MapBagOptions threaded = options_;
  threaded.output = folder_ / "threaded";
  threaded.settings = {"threads=4"};
  run();
  run(threaded);
  for (const char* file : {"trajectory.tum", "map_edges.ply", "map_edges.pcd"}) {
    EXPECT_EQ(contentOf(options_.output / file), contentOf(threaded.output / file)) << file;
    EXPECT_FALSE(contentOf(options_.output / file).empty());
  }
  run(threaded);
  EXPECT_EQ(contentOf(options_.output / "trajectory.tum"),
            contentOf(threaded.output / "trajectory.tum"));
}

TEST_F(MapBagTest, edgesAreWrittenForAllRepresentations) {
  writeBag({simulatedRun().clouds.begin(), simulatedRun().clouds.begin() + 4});
  for (const char* representation : {"all", "random"}) {
    options_.settings = {std::string("map/representation=") + representation};
    EXPECT_GT(run()["edge_voxels"].as<int>(), 100) << representation;
    EXPECT_GT(linesOf(options_.output / "map_edges.ply"), 5U);
    EXPECT_NE(contentOf(options_.output / "config.yaml")
                  .find(std::string("representation: ") + representation),
              std::string::npos);
  }
}

TEST_F(MapBagTest, badCloudsAreCountedAndLeftOut) {
  std::vector<PointCloud2> clouds = simulatedRun().clouds;
  clouds[2].fields.erase(clouds[2].fields.begin());
  clouds[4].data.resize(100);
  clouds[5].data.clear();
  clouds[7].width = 0;
  clouds[8].header.stamp = clouds[6].header.stamp;
  writeBag(clouds);
  const YAML::Node summary = run();
  EXPECT_EQ(summary["scans"].as<int>(), kSweeps - 4);
  EXPECT_EQ(summary["tracked"].as<int>(), kSweeps - 5);
  EXPECT_EQ(summary["stale"].as<int>(), 1);
  EXPECT_EQ(summary["clouds_left_out"]["missing_coordinate"].as<int>(), 1);
  EXPECT_EQ(summary["clouds_left_out"]["data_size"].as<int>(), 2);
  EXPECT_EQ(summary["clouds_left_out"]["empty"].as<int>(), 1);
  EXPECT_TRUE(logged("cloud 2 is left out: there is no field 'x'"));
  EXPECT_TRUE(logged("cloud 4 is left out: its rows are"));
  EXPECT_FALSE(logged("cloud 5"));
  EXPECT_EQ(linesOf(options_.output / "trajectory.tum"), size_t{kSweeps} - 5);
}

TEST_F(MapBagTest, strideAndSkip) {
  writeBag(simulatedRun().clouds);
  options_.stride = 2;
  options_.skipped = {{3, 6}, {9, 9}};
  run();
  const Trajectory trajectory = readTum(options_.output / "trajectory.tum");
  ASSERT_EQ(trajectory.size(), 4U);  // 0, 2, 8, 10
  EXPECT_NEAR(trajectory[2].stamp, simulatedRun().truth[8].stamp, 1e-6);
}

TEST_F(MapBagTest, trajectoryOfTheBase) {
  Pose T_base_sensor = Pose::Identity();
  T_base_sensor.linear() = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T_base_sensor.translation() = Eigen::Vector3d(1, 2, 3);
  const auto& clouds = simulatedRun().clouds;
  {
    rosbag::Bag bag(options_.bag, rosbag::bagmode::Write);
    test::writeClouds(bag, "/points", clouds);
    const ros::Time end = clouds.back().header.stamp;
    test::writeTransform(bag, "/tf_static", end,
                         test::transformOf("base_link", "lidar", end, T_base_sensor));
  }
  MapBagOptions of_base = options_;
  of_base.output = folder_ / "base";
  of_base.frames.base = "base_link";
  run();
  EXPECT_EQ(run(of_base)["tracked"].as<int>(), kSweeps);
  const Trajectory sensor = readTum(options_.output / "trajectory.tum");
  const Trajectory base = readTum(of_base.output / "trajectory.tum");
  ASSERT_EQ(sensor.size(), base.size());
  // The map frames are those of the base and of the sensor at the first scan.
  EXPECT_TRUE(base.front().pose.isApprox(Pose::Identity(), 1e-9));
  for (size_t i = 0; i < base.size(); ++i) {
    const Pose expected = T_base_sensor * sensor[i].pose * T_base_sensor.inverse();
    EXPECT_LT((base[i].pose.translation() - expected.translation()).norm(), 0.02) << i;
    EXPECT_LT(rotationAngle(base[i].pose.inverse() * expected), 0.005) << i;
  }
}

TEST_F(MapBagTest, theMapFrameIsThatOfTheOdometry) {
  const test::SimulatedRun& simulated = simulatedRun();
  Pose T_odom_map(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
  T_odom_map.translation() = Eigen::Vector3d(10, -5, 0);
  {
    rosbag::Bag bag(options_.bag, rosbag::bagmode::Write);
    test::writeClouds(bag, "/points", simulated.clouds);
    for (size_t i = 0; i < simulated.truth.size(); ++i) {
      const ros::Time stamp = simulated.clouds[i].header.stamp;
      test::writeTransform(
          bag, "/tf", stamp,
          test::transformOf("odom", "lidar", stamp, T_odom_map * simulated.truth[i].pose));
    }
  }
  options_.frames.odom = "odom";
  run();
  const Trajectory trajectory = readTum(options_.output / "trajectory.tum");
  ASSERT_EQ(trajectory.size(), size_t{kSweeps});
  for (size_t i = 0; i < trajectory.size(); ++i) {
    const Pose expected = T_odom_map * simulated.truth[i].pose;
    EXPECT_LT((trajectory[i].pose.translation() - expected.translation()).norm(), 0.03) << i;
  }
}

TEST_F(MapBagTest, predictionFromOdometry) {
  const test::SimulatedRun& simulated = simulatedRun();
  {
    rosbag::Bag bag(options_.bag, rosbag::bagmode::Write);
    test::writeClouds(bag, "/points", simulated.clouds);
    for (size_t i = 2; i < simulated.truth.size(); ++i) {
      const ros::Time stamp = simulated.clouds[i].header.stamp;
      test::writeTransform(bag, "/tf", stamp,
                           test::transformOf("odom", "lidar", stamp, simulated.truth[i].pose));
    }
  }
  options_.frames.odom = "odom";
  const YAML::Node summary = run();
  EXPECT_EQ(summary["tracked"].as<int>(), kSweeps);
  EXPECT_EQ(summary["without_odometry"].as<int>(), 2);
  EXPECT_TRUE(
      logged("cloud 0 is predicted at constant velocity: there is no transform from frame "
             "'lidar' to 'odom'"));
  EXPECT_FALSE(logged("cloud 1 is"));
}

TEST_F(MapBagTest, jumpsOfTheOdometryAreToldAndBridged) {
  const test::SimulatedRun& simulated = simulatedRun();
  Pose T_odom_map = Pose::Identity();
  {
    rosbag::Bag bag(options_.bag, rosbag::bagmode::Write);
    test::writeClouds(bag, "/points", simulated.clouds);
    for (size_t i = 0; i < simulated.truth.size(); ++i) {
      if (i == 4 || i == 8) T_odom_map.translation() += Eigen::Vector3d(500e3, 5000e3, -80);
      const ros::Time stamp = simulated.clouds[i].header.stamp;
      test::writeTransform(
          bag, "/tf", stamp,
          test::transformOf("odom", "lidar", stamp, T_odom_map * simulated.truth[i].pose));
    }
  }
  options_.frames.odom = "odom";
  const YAML::Node summary = run();
  EXPECT_EQ(summary["tracked"].as<int>(), kSweeps);
  EXPECT_EQ(summary["odometry_jumps"].as<int>(), 2);
  EXPECT_TRUE(logged("cloud 4 is predicted at constant velocity: its odometry has jumped"));
  EXPECT_FALSE(logged("cloud 8 is"));
  const Trajectory trajectory = readTum(options_.output / "trajectory.tum");
  ASSERT_EQ(trajectory.size(), size_t{kSweeps});
  for (size_t i = 0; i < trajectory.size(); ++i) {
    const Eigen::Vector3d expected = simulated.truth[i].pose.translation();
    EXPECT_LT((trajectory[i].pose.translation() - expected).norm(), 0.03) << i;
  }
}

TEST_F(MapBagTest, aMapOfNoiseIsBegunAnew) {
  std::vector<PointCloud2> clouds = simulatedRun().clouds;
  sim::Scan noise;
  for (const auto& [x, y, z, time] : test::randomSweep(3, 0.0, 4000).points) {
    noise.points.emplace_back(x, y, z);
    noise.times.push_back(time);
  }
  const ros::Time stamp = clouds[0].header.stamp;
  clouds[0] = test::cloudOf(noise);
  clouds[0].header.stamp = stamp;
  writeBag(clouds);
  const YAML::Node summary = run();
  EXPECT_EQ(summary["begun_anew"].as<int>(), 1);
  EXPECT_EQ(summary["lost"].as<int>(), 1);
  EXPECT_EQ(summary["tracked"].as<int>(), kSweeps - 2);
  EXPECT_TRUE(logged("cloud 2: the map is begun anew with it"));
  const Trajectory trajectory = readTum(options_.output / "trajectory.tum");
  ASSERT_EQ(trajectory.size(), size_t{kSweeps} - 2);
  const auto& truth = simulatedRun().truth;
  for (size_t i = 0; i < trajectory.size(); ++i) {
    const Pose expected = truth[2].pose.inverse() * truth[i + 2].pose;
    EXPECT_LT((trajectory[i].pose.translation() - expected.translation()).norm(), 0.05) << i;
  }
}

TEST_F(MapBagTest, garbageStampsAndTransformsLeaveNoTrace) {
  const test::SimulatedRun& simulated = simulatedRun();
  const auto write = [&](bool garbage) {
    rosbag::Bag bag(options_.bag, rosbag::bagmode::Write);
    for (size_t i = 0; i < simulated.clouds.size(); ++i) {
      PointCloud2 cloud = simulated.clouds[i];
      const ros::Time stamp = cloud.header.stamp;
      auto odometry = test::transformOf("odom", "lidar", stamp, simulated.truth[i].pose);
      test::writeTransform(bag, "/tf", stamp, odometry);
      bag.write("/points", stamp, cloud);
      if (!garbage) continue;
      odometry.header.stamp += ros::Duration(0.05);
      odometry.transform.translation.x = 1e300;
      test::writeTransform(bag, "/tf", stamp, odometry);
      odometry.transform.translation.x = 0;
      odometry.header.stamp.sec = i % 2 == 0 ? 4294967267 : stamp.sec + 86400;
      test::writeTransform(bag, "/tf", stamp, odometry);
      cloud.header.stamp = odometry.header.stamp;
      bag.write("/points", stamp, cloud);
    }
  };
  options_.frames.odom = "odom";
  write(false);
  run();
  const std::string clean = contentOf(options_.output / "trajectory.tum");
  write(true);
  const YAML::Node summary = run();
  EXPECT_EQ(clean, contentOf(options_.output / "trajectory.tum"));
  EXPECT_EQ(summary["tracked"].as<int>(), kSweeps);
  EXPECT_EQ(summary["stale"].as<int>(), kSweeps / 2);
  EXPECT_EQ(summary["clouds_left_out"]["bad_stamp"].as<int>(), kSweeps / 2);
  EXPECT_TRUE(logged("the transform from 'odom' to 'lidar' by bag '" + options_.bag +
                     "' is refused: its translation"));
  EXPECT_TRUE(logged("Of this kind: 12."));
  EXPECT_TRUE(logged("4294967267 s"));
  EXPECT_TRUE(logged("mapper/clock_leap"));
}

}  // namespace
}  // namespace edgevox
