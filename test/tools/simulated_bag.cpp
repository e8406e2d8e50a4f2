// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulated_bag.hpp"

#include <tf2_msgs/TFMessage.h>

#include "sim/worlds.hpp"

namespace edgevox::test {

ros::Time stampOf(double seconds) {
  ros::Time time;
  time.fromSec(1700000000.0 + seconds);
  return time;
}

sensor_msgs::PointCloud2 cloudOf(const sim::Scan& scan) {
  sensor_msgs::PointCloud2 cloud = makeCloud(scan.points, 16);
  cloud.header.stamp = stampOf(scan.stamp);
  cloud.fields.push_back(makeField("time", 12, Field::FLOAT32));
  for (size_t i = 0; i < scan.size(); ++i) put(cloud, 0, i, 12, scan.times[i]);
  return cloud;
}

SimulatedRun simulateRun(int sweeps) {
  constexpr int kFirst = 20;  // the sensor stands still for the first second
  const sim::Sensor sensor = sim::makeSensor("32");
  const sim::World world = sim::makeWorld(sim::WorldName::Building, 1);
  const sim::Trajectory path = sim::makeTrajectory(sim::WorldName::Building, sensor);
  SimulatedRun run;
  for (const sim::Scan& scan : sim::simulateSweeps(world, path, sensor, kFirst, sweeps, 1, 2)) {
    run.clouds.push_back(cloudOf(scan));
    run.truth.push_back({run.clouds.back().header.stamp.toSec(), path.poseAt(scan.stamp)});
  }
  return run;
}

geometry_msgs::TransformStamped transformOf(const std::string& parent, const std::string& child,
                                            const ros::Time& stamp, const Pose& pose) {
  const Eigen::Quaterniond q(pose.linear());
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = parent;
  transform.header.stamp = stamp;
  transform.child_frame_id = child;
  transform.transform.translation.x = pose.translation().x();
  transform.transform.translation.y = pose.translation().y();
  transform.transform.translation.z = pose.translation().z();
  transform.transform.rotation.x = q.x();
  transform.transform.rotation.y = q.y();
  transform.transform.rotation.z = q.z();
  transform.transform.rotation.w = q.w();
  return transform;
}

void writeClouds(rosbag::Bag& bag, const std::string& topic,
                 const std::vector<sensor_msgs::PointCloud2>& clouds) {
  for (const auto& cloud : clouds) bag.write(topic, cloud.header.stamp, cloud);
}

void writeTransform(rosbag::Bag& bag, const std::string& topic, const ros::Time& received,
                    const geometry_msgs::TransformStamped& transform) {
  tf2_msgs::TFMessage message;
  message.transforms.push_back(transform);
  bag.write(topic, received, message);
}

}  // namespace edgevox::test
