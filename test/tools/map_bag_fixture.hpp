// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <sensor_msgs/PointCloud2.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "support/temp_folder.hpp"
#include "tools/map_bag_options.hpp"
#include "tools/simulated_bag.hpp"

namespace edgevox::test {

constexpr int kSweeps = 12;

const SimulatedRun& simulatedRun();

std::string contentOf(const std::filesystem::path& file);

/// Runs map_bag on a bag of its own.
class MapBagTest : public ::testing::Test {
 protected:
  MapBagTest();
  ~MapBagTest() override;

  void writeBag(const std::vector<sensor_msgs::PointCloud2>& clouds,
                const std::string& topic = "/points");

  YAML::Node run();
  YAML::Node run(const MapBagOptions& options);

  template <typename Error>
  void expectError(const std::vector<std::string>& words) {
    try {
      run();
      ADD_FAILURE() << "no error; expected " << words.front();
    } catch (const Error& error) {
      expectWords(words, error.what());
    }
  }

  bool logged(const std::string& words) const;

  TempFolder folder_;
  MapBagOptions options_;
  std::ostringstream log_;
  std::string loss_;     ///< of the last run
  std::string warning_;  ///< the same

 private:
  static void expectWords(const std::vector<std::string>& words, const std::string& text);
};

}  // namespace edgevox::test
