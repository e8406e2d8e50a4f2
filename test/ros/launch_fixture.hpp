// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "ros/launch_process.hpp"
#include "support/temp_folder.hpp"
#include "tools/map_bag_options.hpp"

namespace edgevox::test {

using Words = std::vector<std::string>;

/// Starts mapping.launch from a folder of its own, the way a user does.
class LaunchTest : public ::testing::Test {
 protected:
  LaunchTest();
  ~LaunchTest() override;

  std::unique_ptr<Process> start(const Words& command) const;
  std::unique_ptr<Process> launch(const Words& arguments) const;

  /// roslaunch ends by itself, as with exit_at_end.
  void launchToTheEnd(const Words& arguments, double seconds = 60) const;

  void expectSameAsOffline() const;

  std::string log() const;
  bool logged(const std::string& words) const;

  TempFolder folder_;
  std::string launch_file_ = EDGEVOX_SOURCE_DIR "/launch/mapping.launch";
  MapBagOptions offline_;
};

}  // namespace edgevox::test
