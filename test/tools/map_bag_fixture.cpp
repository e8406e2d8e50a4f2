// SPDX-License-Identifier: BSD-3-Clause
#include "tools/map_bag_fixture.hpp"

#include <rosbag/bag.h>

#include <fstream>

#include "tools/console.hpp"
#include "tools/map_bag_run.hpp"

namespace edgevox::test {

const SimulatedRun& simulatedRun() {
  static const SimulatedRun run = simulateRun(kSweeps);
  return run;
}

std::string contentOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

MapBagTest::MapBagTest() {
  options_.bag = (folder_ / "run.bag").string();
  options_.output = folder_ / "out";
}

MapBagTest::~MapBagTest() = default;

void MapBagTest::writeBag(const std::vector<sensor_msgs::PointCloud2>& clouds,
                          const std::string& topic) {
  rosbag::Bag bag(options_.bag, rosbag::bagmode::Write);
  writeClouds(bag, topic, clouds);
}

YAML::Node MapBagTest::run() { return run(options_); }

YAML::Node MapBagTest::run(const MapBagOptions& options) {
  log_.str("");
  Console console(log_, false);
  const MapBagOutcome outcome = runMapBag(options, console);
  loss_ = outcome.loss;
  warning_ = outcome.warning;
  EXPECT_EQ(contentOf(options.output / "summary.json"), outcome.summary.json());
  return YAML::Load(outcome.summary.json());
}

bool MapBagTest::logged(const std::string& words) const {
  return log_.str().find(words) != std::string::npos;
}

void MapBagTest::expectWords(const std::vector<std::string>& words, const std::string& text) {
  for (const std::string& word : words) {
    EXPECT_NE(text.find(word), std::string::npos) << "'" << word << "' in: " << text;
  }
}

}  // namespace edgevox::test
