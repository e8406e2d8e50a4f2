// SPDX-License-Identifier: BSD-3-Clause
// Nodelets loaded into the test's own process.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <nodelet/loader.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>

#include <algorithm>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace edgevox::test {

constexpr double kPatience = 20.0;  // [s of wall clock]

/// Whether the condition comes true in time.
template <typename Condition>
bool eventually(const Condition& condition) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kPatience);
  while (!condition()) {
    if (ros::WallTime::now() > end) return false;
    ros::WallDuration(0.002).sleep();
  }
  return true;
}

inline bool hasWords(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (text.find(word) == std::string::npos) return false;
  }
  return true;
}

/// Keeps all messages of a topic.
template <typename Message>
class Listener {
 public:
  using Pointer = typename Message::ConstPtr;

  explicit Listener(const std::string& topic)
      : subscriber_(ros::NodeHandle().subscribe<Message>(topic, kQueue, &Listener::receive, this)) {
  }

  std::vector<Pointer> messages() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return messages_;
  }
  size_t count() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return messages_.size();
  }
  bool waitFor(size_t number) const {
    return eventually([&] { return count() >= number; });
  }

 private:
  static constexpr uint32_t kQueue = 1000;

  void receive(const Pointer& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    messages_.push_back(message);
  }

  mutable std::mutex mutex_;
  std::vector<Pointer> messages_;
  ros::Subscriber subscriber_;
};

using Status = diagnostic_msgs::DiagnosticStatus;

inline std::string valueOf(const Status& status, const std::string& key) {
  for (const auto& entry : status.values) {
    if (entry.key == key) return entry.value;
  }
  return "";
}

/// Each test has a namespace of its own; the nodelets' names in it are those of mapping.launch.
class NodeletTest : public ::testing::Test {
 protected:
  void TearDown() override {
    loader_.clear();
    ros::param::del(space_);
  }

  std::string resolved(const std::string& name) const { return space_ + "/" + name; }

  template <typename Value>
  void setParameter(const std::string& node, const std::string& name, const Value& value) const {
    ros::param::set(resolved(node + "/" + name), value);
  }

  /// "voxelizer", "edge_extractor", "mapper" or "localizer"
  bool load(const std::string& node) {
    static const std::map<std::string, std::string> types = {
        {"voxelizer", "edgevox/Voxelizer"},
        {"edge_extractor", "edgevox/EdgeExtractor"},
        {"mapper", "edgevox/Mapper"},
        {"localizer", "edgevox/Localizer"}};
    return loader_.load(resolved(node), types.at(node), {}, {});
  }
  bool unload(const std::string& node) { return loader_.unload(resolved(node)); }

  std::vector<Status> statusesOf(const std::string& node) const {
    const std::string name = resolved(node).substr(1) + ": scans";
    std::vector<Status> found;
    for (const auto& message : diagnostics_.messages()) {
      for (const Status& status : message->status) {
        const bool starting = status.values.empty();  // said by the library
        if (status.name == name && !starting) found.push_back(status);
      }
    }
    return found;
  }

  /// Waits for a status of the node in /diagnostics.
  ::testing::AssertionResult tells(const std::string& node,
                                   const std::function<bool(const Status&)>& wanted) const {
    const bool told = eventually([&] {
      const auto statuses = statusesOf(node);
      return std::any_of(statuses.begin(), statuses.end(), wanted);
    });
    if (told) return ::testing::AssertionSuccess();
    auto failure = ::testing::AssertionFailure() << "statuses of " << node << ":";
    for (const Status& s : statusesOf(node)) failure << "\n" << int{s.level} << " " << s.message;
    return failure;
  }
  ::testing::AssertionResult tells(const std::string& node, int level,
                                   const std::vector<std::string>& words) const {
    return tells(node, [&](const Status& status) {
      return status.level == level && hasWords(status.message, words);
    });
  }

  size_t countLogged(int level, const std::vector<std::string>& words) const {
    const auto messages = log_.messages();
    return static_cast<size_t>(std::count_if(messages.begin(), messages.end(), [&](const auto& m) {
      return m->level == level && hasWords(m->msg, words);
    }));
  }
  /// Waits for a message to the user.
  bool logs(int level, const std::vector<std::string>& words) const {
    return eventually([&] { return countLogged(level, words) > 0; });
  }

  const std::string space_ =
      std::string("/") + ::testing::UnitTest::GetInstance()->current_test_info()->name();
  Listener<diagnostic_msgs::DiagnosticArray> diagnostics_{"/diagnostics"};
  Listener<rosgraph_msgs::Log> log_{"/rosout"};
  nodelet::Loader loader_{false};
};

inline int runNodeletTests(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "nodelet_test");
  const ros::NodeHandle keep_alive;
  ros::AsyncSpinner spinner(1);
  spinner.start();
  return RUN_ALL_TESTS();
}

}  // namespace edgevox::test
