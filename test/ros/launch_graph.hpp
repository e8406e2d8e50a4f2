// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/master.h>
#include <ros/node_handle.h>
#include <ros/this_node.h>
#include <tf2_msgs/TFMessage.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

namespace edgevox::test {

inline XmlRpc::XmlRpcValue askMaster(const std::string& method) {
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  if (!ros::master::execute(method, request, response, payload, true)) {
    throw std::runtime_error("the master does not answer " + method);
  }
  return payload;
}

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

inline Users usersIn(XmlRpc::XmlRpcValue& list) {
  Users users;
  for (int i = 0; i < list.size(); ++i) {
    for (int j = 0; j < list[i][1].size(); ++j) users[list[i][0]].insert(list[i][1][j]);
  }
  return users;
}

inline Graph readGraph() {
  XmlRpc::XmlRpcValue state = askMaster("getSystemState");
  return {usersIn(state[0]), usersIn(state[1]), usersIn(state[2])};
}

/// Types by topic.
inline std::map<std::string, std::string> readTypes() {
  XmlRpc::XmlRpcValue list = askMaster("getTopicTypes");
  std::map<std::string, std::string> types;
  for (int i = 0; i < list.size(); ++i) types[list[i][0]] = static_cast<std::string>(list[i][1]);
  return types;
}

/// Whether all three nodelets of a namespace are there.
inline bool isMapping(const std::string& space) {
  const Graph graph = readGraph();
  return graph.isRead(space + "/voxels") && graph.isPublished(space + "/voxels") &&
         graph.isPublished(space + "/edges") && graph.services.count(space + "/save_map") > 0 &&
         graph.services.count(space + "/reset") > 0;
}

/// Remembers which frame is the parent of which, as broadcast on TF.
class FrameTree {
 public:
  using Joint = std::pair<std::string, std::string>;  // parent, child

  const std::set<Joint>& joints() const { return joints_; }
  void clear() { joints_.clear(); }

 private:
  void add(const tf2_msgs::TFMessage::ConstPtr& message) {
    for (const auto& transform : message->transforms) {
      joints_.emplace(transform.header.frame_id, transform.child_frame_id);
    }
  }

  std::set<Joint> joints_;
  ros::NodeHandle handle_;
  ros::Subscriber tf_ = handle_.subscribe("/tf", 1000, &FrameTree::add, this);
  ros::Subscriber static_ = handle_.subscribe("/tf_static", 1000, &FrameTree::add, this);
};

}  // namespace edgevox::test
