// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bag_reader.hpp"

#include <ros/message_traits.h>
#include <rosbag/exceptions.h>
#include <rosbag/query.h>
#include <rosbag/view.h>
#include <tf2_msgs/TFMessage.h>

#include <filesystem>
#include <set>
#include <vector>

namespace edgevox {
namespace {

void open(const std::string& file, rosbag::Bag& bag) {
  if (!std::filesystem::exists(file)) {
    throw BagError("there is no bag '" + file + "'; check the name");
  }
  try {
    bag.open(file, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw BagError("bag '" + file + "' has no index: its recording did not end properly; run " +
                   "'rosbag reindex " + file + "' first");
  } catch (const std::exception& error) {
    throw BagError("'" + file + "' cannot be read as a bag (" + error.what() +
                   "); give a file that rosbag record has written, or try 'rosbag reindex " + file +
                   "' if it is damaged");
  }
}

std::set<std::string> cloudTopics(const rosbag::Bag& bag) {
  std::set<std::string> topics;
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    if (connection->datatype == ros::message_traits::datatype<sensor_msgs::PointCloud2>()) {
      topics.insert(connection->topic);
    }
  }
  return topics;
}

std::string listed(const std::set<std::string>& topics) {
  std::string list;
  for (const std::string& topic : topics) list += (list.empty() ? "" : ", ") + topic;
  return list;
}

std::string chooseTopic(const std::set<std::string>& topics, const std::string& wanted,
                        const std::string& file) {
  if (topics.empty()) {
    throw BagError("bag '" + file + "' has no topic of type sensor_msgs/PointCloud2; see " +
                   "'rosbag info " + file + "'");
  }
  if (!wanted.empty()) {
    if (topics.count(wanted) == 1) return wanted;
    throw BagError("bag '" + file + "' has no clouds on topic '" + wanted +
                   "'; choose with --topic one of: " + listed(topics));
  }
  if (topics.size() == 1) return *topics.begin();
  throw BagError("bag '" + file + "' has clouds on " + std::to_string(topics.size()) +
                 " topics; choose with --topic one of: " + listed(topics));
}

}  // namespace

BagReader::BagReader(const std::string& file, const std::string& topic) : file_(file) {
  open(file, bag_);
  topic_ = chooseTopic(cloudTopics(bag_), topic, file);
  cloud_count_ = rosbag::View(bag_, rosbag::TopicQuery(topic_)).size();
}

std::map<std::string, RefusedTransforms> BagReader::readTransforms(CheckedTransforms& checked) {
  const std::vector<std::string> topics = {"/tf", "tf", "/tf_static", "tf_static"};
  std::map<std::string, RefusedTransforms> all_refused;
  rosbag::View view(bag_, rosbag::TopicQuery(topics));
  try {
    for (const rosbag::MessageInstance& message : view) {
      const auto transforms = message.instantiate<tf2_msgs::TFMessage>();
      if (!transforms) continue;
      const bool is_static = message.getTopic().find("tf_static") != std::string::npos;
      for (const auto& transform : transforms->transforms) {
        const auto refusal = checked.add(transform, "bag '" + file_ + "'", is_static);
        if (!refusal) continue;
        RefusedTransforms& refused = all_refused[refusal->reason];
        if (++refused.count == 1) refused.first = refusal->text;
      }
    }
  } catch (const std::exception& error) {
    throw BagError("the transforms of bag '" + file_ + "' cannot be read (" + error.what() +
                   "); try 'rosbag reindex " + file_ + "'");
  }
  return all_refused;
}

void BagReader::forEachCloud(
    const std::function<void(size_t, const rosbag::MessageInstance&)>& visit) {
  size_t index = 0;
  rosbag::View view(bag_, rosbag::TopicQuery(topic_));
  try {
    for (const rosbag::MessageInstance& message : view) visit(index++, message);
  } catch (const rosbag::BagException& error) {
    throw BagError("bag '" + file_ + "' cannot be read after cloud " + std::to_string(index) +
                   " of " + std::to_string(cloud_count_) + " (" + error.what() +
                   "); try 'rosbag reindex " + file_ + "'");
  }
}

sensor_msgs::PointCloud2::ConstPtr BagReader::decode(const rosbag::MessageInstance& message) {
  try {
    return message.instantiate<sensor_msgs::PointCloud2>();
  } catch (const rosbag::BagException&) {
    throw;
  } catch (const std::exception&) {  // lengths that do not fit the message
    return nullptr;
  }
}

}  // namespace edgevox
