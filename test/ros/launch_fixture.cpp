// SPDX-License-Identifier: BSD-3-Clause
#include "ros/launch_fixture.hpp"

#include <ros/param.h>

#include <iostream>

#include "ros/launch_run.hpp"
#include "tools/map_bag_fixture.hpp"

namespace edgevox::test {

LaunchTest::LaunchTest() {
  ros::param::del("/use_sim_time");
  offline_.bag = (folder_ / "run.bag").string();
  offline_.output = folder_ / "offline";
}

LaunchTest::~LaunchTest() {
  if (HasFailure()) std::cout << log() << std::endl;
}

std::unique_ptr<Process> LaunchTest::start(const Words& command) const {
  return std::make_unique<Process>(command, folder_.path(), folder_ / "log.txt");
}

std::unique_ptr<Process> LaunchTest::launch(const Words& arguments) const {
  Words command = {"roslaunch", launch_file_, "rviz:=false"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return start(command);
}

void LaunchTest::launchToTheEnd(const Words& arguments, double seconds) const {
  const auto roslaunch = launch(arguments);
  ASSERT_TRUE(roslaunch->waitForEnd(seconds)) << "roslaunch does not end";
  EXPECT_EQ(roslaunch->exitCode(), 0);
}

void LaunchTest::expectSameAsOffline() const {
  mapOffline(offline_);
  expectSameRun(folder_ / "out", offline_.output);
}

std::string LaunchTest::log() const { return contentOf(folder_ / "log.txt"); }

bool LaunchTest::logged(const std::string& words) const {
  return log().find(words) != std::string::npos;
}

}  // namespace edgevox::test
