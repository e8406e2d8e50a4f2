// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/subscriber.h>
#include <tf2_msgs/TFMessage.h>

#include <map>
#include <set>
#include <string>
#include <utility>

namespace edgevox::test {

/// Names of topics or services, each with its nodes.
using Users = std::map<std::string, std::set<std::string>>;

/// Who publishes, subscribes and serves what.
struct Graph {
  Users publishers;
  Users subscribers;
  Users services;

  bool isPublished(const std::string& topic) const { return publishers.count(topic) > 0; }
  bool isRead(const std::string& topic) const { return subscribers.count(topic) > 0; }
};

Graph readGraph();

/// Types by topic.
std::map<std::string, std::string> readTypes();

/// Whether all three nodelets of a namespace are there.
bool isMapping(const std::string& space);

/// Remembers which frame is the parent of which, as broadcast on TF.
class FrameTree {
 public:
  using Joint = std::pair<std::string, std::string>;  // parent, child

  FrameTree();

  const std::set<Joint>& joints() const { return joints_; }
  void clear() { joints_.clear(); }

 private:
  void add(const tf2_msgs::TFMessage::ConstPtr& message);

  std::set<Joint> joints_;
  ros::Subscriber tf_;
  ros::Subscriber static_;
};

}  // namespace edgevox::test
