// SPDX-License-Identifier: BSD-3-Clause
// Recorded bags at the default configuration, where they are to be had.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "support/temp_folder.hpp"
#include "tools/map_bag_fixture.hpp"
#include "tools/map_bag_run.hpp"

namespace edgevox::test {
namespace {

namespace fs = std::filesystem;

class RealData : public ::testing::Test {
 protected:
  /// False where the bag is not to be had.
  bool find(const std::string& sequence) {
    const char* folder = std::getenv("EDGEVOX_DATA");
    const fs::path data = folder != nullptr ? folder : EDGEVOX_DEFAULT_DATA;
    bag_ = (data / (sequence + ".bag")).string();
    reference_ = (data / (sequence + ".tum")).string();
    return fs::exists(bag_) && fs::exists(reference_);
  }

  YAML::Node run(const std::string& name, const std::vector<std::string>& settings) {
    MapBagOptions options;
    options.bag = bag_;
    options.reference = reference_;
    options.output = folder_ / name;
    options.settings = settings;
    std::ostringstream log;
    Console console(log, false);
    return YAML::Load(runMapBag(options, console).summary.json());
  }

  std::string trajectoryOf(const std::string& name) {
    return contentOf(folder_ / name / "trajectory.tum");
  }

  TempFolder folder_;
  std::string bag_;
  std::string reference_;
};
/// Distances of the relative error of moving pairs [m].
struct Bounds {
  double median;
  double p95;
};

void expectTracked(const YAML::Node& summary, int scans, const Bounds& bounds) {
  EXPECT_EQ(scans, summary["scans"].as<int>());
  EXPECT_EQ(scans, summary["tracked"].as<int>());
  EXPECT_EQ(0, summary["lost"].as<int>());
  const auto median = summary["rpe_median_m"].as<double>();
  const auto p95 = summary["rpe_p95_m"].as<double>();
  ::testing::Test::RecordProperty("rpe_median_m", std::to_string(median));
  ::testing::Test::RecordProperty("rpe_p95_m", std::to_string(p95));
  EXPECT_GE(summary["moving_pairs"].as<int>(), scans / 2);
  EXPECT_LE(median, bounds.median);
  EXPECT_LE(p95, bounds.p95);
}

TEST_F(RealData, HandheldWithASparseMap) {
  if (!find("handheld_a")) GTEST_SKIP() << "no handheld_a.bag";
  expectTracked(run("sparse", {}), 90, {0.007, 0.020});
}

TEST_F(RealData, HandheldWithAllVoxels) {
  if (!find("handheld_a")) GTEST_SKIP() << "no handheld_a.bag";
  expectTracked(run("all", {"map/representation=all"}), 90, {0.006, 0.020});
}

TEST_F(RealData, StreetIsTheSameWithTwoThreads) {
  if (!find("street_a")) GTEST_SKIP() << "no street_a.bag";
  expectTracked(run("one", {"threads=1"}), 22, {0.012, 0.020});
  expectTracked(run("two", {"threads=2"}), 22, {0.012, 0.020});
  EXPECT_GT(trajectoryOf("one").size(), 1000U);
  EXPECT_EQ(trajectoryOf("one"), trajectoryOf("two"));
}

}  // namespace
}  // namespace edgevox::test
