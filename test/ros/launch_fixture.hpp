// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <ros/param.h>

#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "launch_process.hpp"
#include "launch_run.hpp"
#include "support/temp_folder.hpp"

namespace edgevox::test {

using Words = std::vector<std::string>;

/// Starts mapping.launch from a folder of its own, the way a user does.
class LaunchTest : public ::testing::Test {
 protected:
  LaunchTest() {
    ros::param::del("/use_sim_time");
    offline_.bag = (folder_ / "run.bag").string();
    offline_.output = folder_ / "offline";
  }

  ~LaunchTest() override {
    if (HasFailure()) std::cout << log() << std::endl;
  }

  std::unique_ptr<Process> start(const Words& command) const {
    return std::make_unique<Process>(command, folder_.path(), folder_ / "log.txt");
  }

  std::unique_ptr<Process> launch(const Words& arguments) const {
    Words command = {"roslaunch", launch_file_, "rviz:=false"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return start(command);
  }

  /// roslaunch ends by itself, as with exit_at_end.
  void launchToTheEnd(const Words& arguments, double seconds = 60) const {
    const auto roslaunch = launch(arguments);
    ASSERT_TRUE(roslaunch->waitForEnd(seconds)) << "roslaunch does not end";
    EXPECT_EQ(roslaunch->exitCode(), 0);
  }

  void expectSameAsOffline() const {
    mapOffline(offline_);
    expectSameRun(folder_ / "out", offline_.output);
  }

  std::string log() const { return contentOf(folder_ / "log.txt"); }
  bool logged(const std::string& words) const { return log().find(words) != std::string::npos; }

  TempFolder folder_;
  std::string launch_file_ = EDGEVOX_SOURCE_DIR "/launch/mapping.launch";
  MapBagOptions offline_;
};

}  // namespace edgevox::test
