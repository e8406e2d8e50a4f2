// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bag_reader.hpp"

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <tf2_msgs/TFMessage.h>

#include <boost/make_shared.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <utility>

#include "tools/message_lengths.hpp"

namespace edgevox {
namespace {

void requireFile(const std::string& name) {
  if (!std::filesystem::exists(name)) {
    throw BagError("there is no bag '" + name + "'; check the name");
  }
  if (std::filesystem::is_directory(name)) {
    throw BagError("'" + name + "' is a folder; give a file that rosbag record has written");
  }
}

template <typename Read>
auto readOrRefuse(const std::string& name, const Read& read) {
  try {
    return read();
  } catch (const BagDamage& damage) {
    throw BagError("'" + name + "' cannot be read as a bag (" + damage.what() +
                   "); give a file that rosbag record has written, or try 'rosbag reindex " + name +
                   "' if it is damaged");
  }
}

BagFile open(const std::string& name) {
  requireFile(name);
  return readOrRefuse(name, [&] { return BagFile(name); });
}

std::set<std::string> cloudTopics(const BagIndex& index) {
  std::set<std::string> topics;
  for (const BagEntry& entry : index.entries) {
    const BagConnection& connection = index.connections.at(entry.connection);
    if (connection.datatype == ros::message_traits::datatype<sensor_msgs::PointCloud2>()) {
      topics.insert(connection.topic);
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

template <typename Message>
bool hasType(const BagConnection& connection) {
  return connection.md5sum == ros::message_traits::md5sum<Message>();
}

/// `fits` tells whether the lengths within the bytes are right.
template <typename Message>
boost::shared_ptr<Message> decode(const MessageBytes& bytes, bool fits) {
  if (!fits) throw BagDamage("the lengths within a message do not fit it");
  auto message = boost::make_shared<Message>();
  ros::serialization::IStream stream(bytes.data, bytes.size);
  ros::serialization::deserialize(stream, *message);
  return message;
}

/// "3, 5 to 7"
std::string rangesOf(const std::vector<size_t>& numbers) {
  std::string text;
  for (size_t first = 0, last = 0; first < numbers.size(); first = ++last) {
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += (first == 0 ? "" : ", ") + std::to_string(numbers[first]);
    if (last > first) text += " to " + std::to_string(numbers[last]);
  }
  return text;
}

std::string textOf(uint64_t chunk, const BagLoss& loss) {
  std::string lost = loss.clouds.empty() ? "" : "cloud " + rangesOf(loss.clouds);
  if (loss.transforms > 0) {
    lost +=
        (lost.empty() ? "" : " and ") + std::to_string(loss.transforms) + " messages of transforms";
  }
  return "the chunk at byte " + std::to_string(chunk) + " is damaged (" + loss.fault +
         "): " + lost + " could not be read";
}

}  // namespace

std::vector<std::string> textsOf(const std::map<uint64_t, BagLoss>& losses) {
  std::vector<std::string> texts;
  for (const auto& [chunk, loss] : losses) texts.push_back(textOf(chunk, loss));
  return texts;
}

BagReader::BagReader(const std::string& file, const std::string& topic)
    : name_(file),
      file_(open(file)),
      index_(readOrRefuse(file, [&] { return readBagIndex(file_); })),
      chunks_(file_, index_),
      topic_(chooseTopic(cloudTopics(index_), topic, file)),
      clouds_(entriesOn({topic_})) {}

std::map<std::string, RefusedTransforms> BagReader::readTransforms(CheckedTransforms& checked) {
  std::map<std::string, RefusedTransforms> all_refused;
  for (const BagEntry& entry : entriesOn({"/tf", "tf", "/tf_static", "tf_static"})) {
    const BagConnection& connection = connectionOf(entry);
    if (!hasType<tf2_msgs::TFMessage>(connection)) continue;
    const bool is_static = connection.topic.find("tf_static") != std::string::npos;
    try {
      const MessageBytes bytes = chunks_.read(entry);
      const auto message =
          decode<tf2_msgs::TFMessage>(bytes, isTransformsOfSize(bytes.data, bytes.size));
      for (const auto& transform : message->transforms) {
        const auto refusal = checked.add(transform, "bag '" + name_ + "'", is_static);
        if (!refusal) continue;
        RefusedTransforms& refused = all_refused[refusal->reason];
        if (++refused.count == 1) refused.first = refusal->text;
      }
    } catch (const BagDamage& damage) {
      ++lossAt(entry, damage.what()).transforms;
    }
  }
  return all_refused;
}

void BagReader::forEachCloud(const std::function<void(size_t, const ReadCloud&)>& visit) {
  for (size_t i = 0; i < clouds_.size(); ++i) {
    visit(i, [&] { return readCloud(i, clouds_[i]); });
  }
}

BagCloud BagReader::readCloud(size_t index, const BagEntry& entry) {
  if (!hasType<sensor_msgs::PointCloud2>(connectionOf(entry))) {
    return {nullptr, "undecodable",
            "it is of another version of sensor_msgs/PointCloud2, see 'rosbag check'"};
  }
  try {
    const MessageBytes bytes = chunks_.read(entry);
    return {decode<sensor_msgs::PointCloud2>(bytes, isCloudOfSize(bytes.data, bytes.size)), "", ""};
  } catch (const BagDamage& damage) {
    lossAt(entry, damage.what()).clouds.push_back(index);
    return {nullptr, "unreadable",
            "the chunk at byte " + std::to_string(entry.chunk) + " of the bag is damaged (" +
                damage.what() + ")"};
  }
}

BagLoss& BagReader::lossAt(const BagEntry& entry, const std::string& fault) {
  BagLoss& loss = losses_[entry.chunk];
  if (loss.fault.empty()) loss.fault = fault;
  return loss;
}

std::vector<BagEntry> BagReader::entriesOn(const std::vector<std::string>& topics) const {
  std::vector<BagEntry> entries;
  for (const BagEntry& entry : index_.entries) {
    const std::string& topic = connectionOf(entry).topic;
    if (std::count(topics.begin(), topics.end(), topic) > 0) entries.push_back(entry);
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const BagEntry& a, const BagEntry& b) { return a.received < b.received; });
  return entries;
}

const BagConnection& BagReader::connectionOf(const BagEntry& entry) const {
  return index_.connections.at(entry.connection);
}

}  // namespace edgevox
