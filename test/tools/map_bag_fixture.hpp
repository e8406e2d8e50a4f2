// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "simulated_bag.hpp"
#include "support/temp_folder.hpp"
#include "tools/map_bag_run.hpp"

namespace edgevox::test {

constexpr int kSweeps = 12;

inline const SimulatedRun& simulatedRun() {
  static const SimulatedRun run = simulateRun(kSweeps);
  return run;
}

inline std::string contentOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// Runs map_bag on a bag of its own.
class MapBagTest : public ::testing::Test {
 protected:
  MapBagTest() {
    options_.bag = (folder_ / "run.bag").string();
    options_.output = folder_ / "out";
  }

  void writeBag(const std::vector<sensor_msgs::PointCloud2>& clouds,
                const std::string& topic = "/points") {
    rosbag::Bag bag(options_.bag, rosbag::bagmode::Write);
    writeClouds(bag, topic, clouds);
  }

  YAML::Node run() { return run(options_); }

  YAML::Node run(const MapBagOptions& options) {
    log_.str("");
    Console console(log_, false);
    const MapBagOutcome outcome = runMapBag(options, console);
    loss_ = outcome.loss;
    EXPECT_EQ(contentOf(options.output / "summary.json"), outcome.summary.json());
    return YAML::Load(outcome.summary.json());
  }

  template <typename Error>
  void expectError(const std::vector<std::string>& words) {
    try {
      run();
      ADD_FAILURE() << "no error; expected " << words.front();
    } catch (const Error& error) {
      for (const std::string& word : words) {
        EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
            << "'" << word << "' in: " << error.what();
      }
    }
  }

  bool logged(const std::string& words) const {
    return log_.str().find(words) != std::string::npos;
  }

  TempFolder folder_;
  MapBagOptions options_;
  std::ostringstream log_;
  std::string loss_;  ///< of the last run
};

}  // namespace edgevox::test
