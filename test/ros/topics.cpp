// SPDX-License-Identifier: BSD-3-Clause
#include "ros/topics.hpp"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <edgevox/LoadMap.h>
#include <edgevox/SaveMap.h>
#include <edgevox/ScanReport.h>
#include <edgevox/VoxelScanStamped.h>
#include <geometry_msgs/PoseArray.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <ros/node_handle.h>
#include <ros/service.h>
#include <ros/time.h>
#include <rosgraph_msgs/Log.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_srvs/Trigger.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include <boost/make_shared.hpp>

namespace edgevox::test {

bool eventually(const std::function<bool()>& condition) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kPatience);
  while (!condition()) {
    if (ros::WallTime::now() > end) return false;
    ros::WallDuration(0.002).sleep();
  }
  return true;
}

template <typename Message>
Listener<Message>::Listener(const std::string& topic) {
  constexpr uint32_t kQueue = 1000;
  subscriber_ = ros::NodeHandle().subscribe<Message>(topic, kQueue, &Listener::receive, this);
}

template <typename Message>
std::vector<typename Listener<Message>::Pointer> Listener<Message>::messages() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return messages_;
}

template <typename Message>
size_t Listener<Message>::count() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return messages_.size();
}

template <typename Message>
bool Listener<Message>::waitFor(size_t number) const {
  return eventually([&] { return count() >= number; });
}

template <typename Message>
void Listener<Message>::receive(const Pointer& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  messages_.push_back(message);
}

template class Listener<ScanReport>;
template class Listener<VoxelScanStamped>;
template class Listener<diagnostic_msgs::DiagnosticArray>;
template class Listener<geometry_msgs::PoseArray>;
template class Listener<nav_msgs::Odometry>;
template class Listener<nav_msgs::Path>;
template class Listener<rosgraph_msgs::Log>;
template class Listener<sensor_msgs::PointCloud2>;
template class Listener<tf2_msgs::TFMessage>;
template class Listener<visualization_msgs::Marker>;
template class Listener<visualization_msgs::MarkerArray>;

template <typename Message>
ros::Publisher advertise(const std::string& topic, uint32_t queue_size, bool latch) {
  return ros::NodeHandle().advertise<Message>(topic, queue_size, latch);
}
template ros::Publisher advertise<VoxelScanStamped>(const std::string&, uint32_t, bool);
template ros::Publisher advertise<geometry_msgs::PoseWithCovarianceStamped>(const std::string&,
                                                                            uint32_t, bool);
template ros::Publisher advertise<sensor_msgs::PointCloud2>(const std::string&, uint32_t, bool);
template ros::Publisher advertise<tf2_msgs::TFMessage>(const std::string&, uint32_t, bool);

template <typename Message>
void publish(const ros::Publisher& publisher, const Message& message) {
  publisher.publish(message);
}
template void publish(const ros::Publisher&, const VoxelScanStamped&);
template void publish(const ros::Publisher&, const geometry_msgs::PoseWithCovarianceStamped&);
template void publish(const ros::Publisher&, const sensor_msgs::PointCloud2&);
template void publish(const ros::Publisher&, const tf2_msgs::TFMessage&);

template <typename Message>
void publishShared(const ros::Publisher& publisher,
                   const boost::shared_ptr<const Message>& shared) {
  publisher.publish(shared);
}
template void publishShared(const ros::Publisher&, const VoxelScanStamped::ConstPtr&);
template void publishShared(const ros::Publisher&, const sensor_msgs::PointCloud2::ConstPtr&);

template <typename Message>
boost::shared_ptr<const Message> copyOf(const Message& message) {
  return boost::make_shared<Message>(message);
}
template VoxelScanStamped::ConstPtr copyOf(const VoxelScanStamped&);
template sensor_msgs::PointCloud2::ConstPtr copyOf(const sensor_msgs::PointCloud2&);

template <typename Service>
bool callService(const std::string& name, Service& service) {
  return ros::service::call(name, service);
}
template bool callService(const std::string&, LoadMap&);
template bool callService(const std::string&, SaveMap&);
template bool callService(const std::string&, std_srvs::Trigger&);

}  // namespace edgevox::test
