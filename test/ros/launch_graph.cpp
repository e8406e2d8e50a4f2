// SPDX-License-Identifier: BSD-3-Clause
#include "ros/launch_graph.hpp"

#include <ros/master.h>
#include <ros/node_handle.h>
#include <ros/this_node.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <stdexcept>

namespace edgevox::test {
namespace {

XmlRpc::XmlRpcValue askMaster(const std::string& method) {
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  if (!ros::master::execute(method, request, response, payload, true)) {
    throw std::runtime_error("the master does not answer " + method);
  }
  return payload;
}

Users usersIn(XmlRpc::XmlRpcValue& list) {
  Users users;
  for (int i = 0; i < list.size(); ++i) {
    for (int j = 0; j < list[i][1].size(); ++j) users[list[i][0]].insert(list[i][1][j]);
  }
  return users;
}

}  // namespace

Graph readGraph() {
  XmlRpc::XmlRpcValue state = askMaster("getSystemState");
  return {usersIn(state[0]), usersIn(state[1]), usersIn(state[2])};
}

std::map<std::string, std::string> readTypes() {
  XmlRpc::XmlRpcValue list = askMaster("getTopicTypes");
  std::map<std::string, std::string> types;
  for (int i = 0; i < list.size(); ++i) types[list[i][0]] = static_cast<std::string>(list[i][1]);
  return types;
}

bool isMapping(const std::string& space) {
  const Graph graph = readGraph();
  return graph.isRead(space + "/voxels") && graph.isPublished(space + "/voxels") &&
         graph.isPublished(space + "/edges") && graph.services.count(space + "/save_map") > 0 &&
         graph.services.count(space + "/reset") > 0;
}

FrameTree::FrameTree() {
  ros::NodeHandle handle;
  tf_ = handle.subscribe("/tf", 1000, &FrameTree::add, this);
  static_ = handle.subscribe("/tf_static", 1000, &FrameTree::add, this);
}

void FrameTree::add(const tf2_msgs::TFMessage::ConstPtr& message) {
  for (const auto& transform : message->transforms) {
    joints_.emplace(transform.header.frame_id, transform.child_frame_id);
  }
}

}  // namespace edgevox::test
