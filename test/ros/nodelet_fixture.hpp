// SPDX-License-Identifier: BSD-3-Clause
// Nodelets loaded into the test's own process.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <nodelet/loader.h>
#include <ros/param.h>
#include <rosgraph_msgs/Log.h>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "ros/topics.hpp"

namespace edgevox::test {

bool hasWords(const std::string& text, const std::vector<std::string>& words);

using Status = diagnostic_msgs::DiagnosticStatus;

std::string valueOf(const Status& status, const std::string& key);

/// Each test has a namespace of its own; the nodelets' names in it are those of mapping.launch.
class NodeletTest : public ::testing::Test {
 protected:
  NodeletTest();
  ~NodeletTest() override;

  void TearDown() override;

  std::string resolved(const std::string& name) const { return space_ + "/" + name; }

  template <typename Value>
  void setParameter(const std::string& node, const std::string& name, const Value& value) const {
    ros::param::set(resolved(node + "/" + name), value);
  }

  /// "voxelizer", "edge_extractor", "mapper" or "localizer"
  bool load(const std::string& node);
  bool unload(const std::string& node);

  std::vector<Status> statusesOf(const std::string& node) const;

  /// Waits for a status of the node in /diagnostics.
  ::testing::AssertionResult tells(const std::string& node,
                                   const std::function<bool(const Status&)>& wanted) const;
  ::testing::AssertionResult tells(const std::string& node, int level,
                                   const std::vector<std::string>& words) const;

  size_t countLogged(int level, const std::vector<std::string>& words) const;
  /// Waits for a message to the user.
  bool logs(int level, const std::vector<std::string>& words) const;

  const std::string space_;
  Listener<diagnostic_msgs::DiagnosticArray> diagnostics_{"/diagnostics"};
  Listener<rosgraph_msgs::Log> log_{"/rosout"};
  nodelet::Loader loader_{false};
};

int runNodeletTests(int argc, char** argv);

}  // namespace edgevox::test
