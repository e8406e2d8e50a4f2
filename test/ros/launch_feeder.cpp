// SPDX-License-Identifier: BSD-3-Clause
#include "ros/launch_feeder.hpp"

#include <edgevox/SaveMap.h>
#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>

#include "ros/launch_graph.hpp"
#include "ros/launch_process.hpp"
#include "ros/topics.hpp"
#include "tools/cloud_message.hpp"

namespace edgevox::test {

Feeder::Feeder(const std::string& space, const std::string& points)
    : space_(space),
      publisher_(advertise<sensor_msgs::PointCloud2>(points, 10)),
      subscriber_(ros::NodeHandle().subscribe(space + "/scan_report", 100, &Feeder::add, this)) {}

bool Feeder::connect(const std::string& frame) {
  if (!waitFor([this] { return isMapping(space_); })) return false;
  sensor_msgs::PointCloud2 probe = makeCloud({{5, 0, 0}});
  probe.header.frame_id = frame;
  const auto gets_through = [&] {
    probe.header.stamp += ros::Duration(0.01);
    return feed(probe, 0.5) && reports_.back().status == "too_few";
  };
  if (!waitFor(gets_through)) return false;
  reports_.clear();
  return reset();
}

bool Feeder::feed(const sensor_msgs::PointCloud2& cloud, double seconds) {
  publish(publisher_, cloud);
  return waitFor([&] { return hasReport(cloud.header.stamp); }, seconds);
}

bool Feeder::save(const std::filesystem::path& folder) const {
  SaveMap save;
  save.request.folder = folder.string();
  return callService(space_ + "/save_map", save) && save.response.success;
}

bool Feeder::reset() const {
  std_srvs::Trigger reset;
  return callService(space_ + "/reset", reset) && reset.response.success;
}

bool Feeder::hasReport(const ros::Time& stamp) const {
  for (const ScanReport& report : reports_) {
    if (report.header.stamp == stamp) return true;
  }
  return false;
}

}  // namespace edgevox::test
