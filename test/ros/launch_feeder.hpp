// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <edgevox/SaveMap.h>
#include <edgevox/ScanReport.h>
#include <ros/node_handle.h>
#include <ros/service.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_srvs/Trigger.h>

#include <filesystem>
#include <string>
#include <vector>

#include "launch_graph.hpp"
#include "launch_process.hpp"
#include "tools/cloud_message.hpp"

namespace edgevox::test {

/// Gives clouds to one mapping and waits for its reports, so that none is ever dropped.
class Feeder {
 public:
  /// `space`: of the mapping, with a slash. `points`: its topic of clouds.
  Feeder(const std::string& space, const std::string& points)
      : space_(space),
        publisher_(handle_.advertise<sensor_msgs::PointCloud2>(points, 10)),
        subscriber_(handle_.subscribe(space + "/scan_report", 100, &Feeder::add, this)) {}

  /// Sends clouds of one point until one gets through to the mapper and finds its transforms
  /// there; then resets the mapper.
  bool connect(const std::string& frame) {
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

  /// Whether there is a report on the cloud.
  bool feed(const sensor_msgs::PointCloud2& cloud, double seconds = 20) {
    publisher_.publish(cloud);
    return waitFor([&] { return hasReport(cloud.header.stamp); }, seconds);
  }

  /// On all clouds since connect().
  const std::vector<ScanReport>& reports() const { return reports_; }

  bool save(const std::filesystem::path& folder) const {
    SaveMap save;
    save.request.folder = folder.string();
    return ros::service::call(space_ + "/save_map", save) && save.response.success;
  }

  bool reset() const {
    std_srvs::Trigger reset;
    return ros::service::call(space_ + "/reset", reset) && reset.response.success;
  }

 private:
  void add(const ScanReport::ConstPtr& report) { reports_.push_back(*report); }

  bool hasReport(const ros::Time& stamp) const {
    for (const ScanReport& report : reports_) {
      if (report.header.stamp == stamp) return true;
    }
    return false;
  }

  std::string space_;
  std::vector<ScanReport> reports_;
  ros::NodeHandle handle_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
};

}  // namespace edgevox::test
