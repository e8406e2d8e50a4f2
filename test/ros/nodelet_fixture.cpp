// SPDX-License-Identifier: BSD-3-Clause
#include "ros/nodelet_fixture.hpp"

#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <algorithm>
#include <map>

namespace edgevox::test {

bool hasWords(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (text.find(word) == std::string::npos) return false;
  }
  return true;
}

std::string valueOf(const Status& status, const std::string& key) {
  for (const auto& entry : status.values) {
    if (entry.key == key) return entry.value;
  }
  return "";
}

NodeletTest::NodeletTest()
    : space_(std::string("/") + ::testing::UnitTest::GetInstance()->current_test_info()->name()) {}

NodeletTest::~NodeletTest() = default;

void NodeletTest::TearDown() {
  loader_.clear();
  ros::param::del(space_);
}

bool NodeletTest::load(const std::string& node) {
  static const std::map<std::string, std::string> types = {
      {"voxelizer", "edgevox/Voxelizer"},
      {"edge_extractor", "edgevox/EdgeExtractor"},
      {"mapper", "edgevox/Mapper"},
      {"localizer", "edgevox/Localizer"}};
  return loader_.load(resolved(node), types.at(node), {}, {});
}

bool NodeletTest::unload(const std::string& node) { return loader_.unload(resolved(node)); }

std::vector<Status> NodeletTest::statusesOf(const std::string& node) const {
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

::testing::AssertionResult NodeletTest::tells(
    const std::string& node, const std::function<bool(const Status&)>& wanted) const {
  const bool told = eventually([&] {
    const auto statuses = statusesOf(node);
    return std::any_of(statuses.begin(), statuses.end(), wanted);
  });
  if (told) return ::testing::AssertionSuccess();
  auto failure = ::testing::AssertionFailure() << "statuses of " << node << ":";
  for (const Status& s : statusesOf(node)) failure << "\n" << int{s.level} << " " << s.message;
  return failure;
}

::testing::AssertionResult NodeletTest::tells(const std::string& node, int level,
                                              const std::vector<std::string>& words) const {
  return tells(node, [&](const Status& status) {
    return status.level == level && hasWords(status.message, words);
  });
}

size_t NodeletTest::countLogged(int level, const std::vector<std::string>& words) const {
  const auto messages = log_.messages();
  return static_cast<size_t>(std::count_if(messages.begin(), messages.end(), [&](const auto& m) {
    return m->level == level && hasWords(m->msg, words);
  }));
}

bool NodeletTest::logs(int level, const std::vector<std::string>& words) const {
  return eventually([&] { return countLogged(level, words) > 0; });
}

int runNodeletTests(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "nodelet_test");
  const ros::NodeHandle keep_alive;
  ros::AsyncSpinner spinner(1);
  spinner.start();
  return RUN_ALL_TESTS();
}

}  // namespace edgevox::test
