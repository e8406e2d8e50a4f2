// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <edgevox/ScanReport.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>
#include <sensor_msgs/PointCloud2.h>

#include <filesystem>
#include <string>
#include <vector>

namespace edgevox::test {

/// Gives clouds to one mapping and waits for its reports, so that none is ever dropped.
class Feeder {
 public:
  /// `space`: of the mapping, with a slash. `points`: its topic of clouds.
  Feeder(const std::string& space, const std::string& points);

  /// Sends clouds of one point until one gets through to the mapper and finds its transforms
  /// there; then resets the mapper.
  bool connect(const std::string& frame);

  /// Whether there is a report on the cloud.
  bool feed(const sensor_msgs::PointCloud2& cloud, double seconds = 20);

  /// On all clouds since connect().
  const std::vector<ScanReport>& reports() const { return reports_; }

  bool save(const std::filesystem::path& folder) const;

  bool reset() const;

 private:
  void add(const ScanReport::ConstPtr& report) { reports_.push_back(*report); }

  bool hasReport(const ros::Time& stamp) const;

  std::string space_;
  std::vector<ScanReport> reports_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
};

}  // namespace edgevox::test
