// SPDX-License-Identifier: BSD-3-Clause
// Recorded bags through mapping.launch, where they are to be had; at rates at which a busy computer
// drops nothing either.
#include <ros/init.h>
#include <ros/node_handle.h>
#include <yaml-cpp/yaml.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "ros/launch_fixture.hpp"
#include "ros/launch_run.hpp"

namespace edgevox::test {
namespace {

namespace fs = std::filesystem;

class RealData : public LaunchTest {
 protected:
  /// False where the bag is not to be had.
  bool find(const std::string& sequence) {
    const char* folder = std::getenv("EDGEVOX_DATA");
    const fs::path data = folder != nullptr ? folder : EDGEVOX_DEFAULT_DATA;
    offline_.bag = fs::absolute(data / (sequence + ".bag")).string();
    return fs::exists(offline_.bag);
  }

  void expectAllTracked(const std::string& rate, int scans) {
    launchToTheEnd({"bag:=" + offline_.bag, "rate:=" + rate, "output:=out", "exit_at_end:=true"});
    expectSameAsOffline();
    const YAML::Node summary = summaryOf(folder_ / "out");
    EXPECT_EQ(summary["tracked"].as<int>(), scans);
    for (const char* latency : {"latency_ms_median", "latency_ms_p95"}) {
      RecordProperty(latency, summary[latency].as<std::string>());
    }
  }
};

TEST_F(RealData, handheld) {
  if (!find("handheld_a")) GTEST_SKIP() << "no handheld_a.bag";
  expectAllTracked("5", 90);  // 10 Hz
}

TEST_F(RealData, street) {
  if (!find("street_a")) GTEST_SKIP() << "no street_a.bag";
  expectAllTracked("0.5", 22);  // 5 Hz
}

}  // namespace
}  // namespace edgevox::test

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "real_data_test");
  const ros::NodeHandle connected;
  return RUN_ALL_TESTS();
}
