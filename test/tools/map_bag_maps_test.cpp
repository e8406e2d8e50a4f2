// SPDX-License-Identifier: BSD-3-Clause
// Map files that map_bag writes and reads.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "edgevox/io/map_file.hpp"
#include "edgevox/io/trajectory_io.hpp"
#include "tools/map_bag_fixture.hpp"
#include "tools/options.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;
using test::contentOf;
using test::kSweeps;
using test::simulatedRun;

class MapBagMaps : public test::MapBagTest {
 protected:
  MapBagMaps() { writeBag(simulatedRun().clouds); }

  /// The run in a folder of its own.
  MapBagOptions optionsFor(const std::string& folder) const {
    MapBagOptions options = options_;
    options.output = folder_ / folder;
    return options;
  }

  std::string fileOf(const std::string& folder) const {
    return (folder_ / folder / "map.edgevox").string();
  }
};

TEST_F(MapBagMaps, mappingGoesOnAsIfItHadNotStopped) {
  run(optionsFor("whole"));
  MapBagOptions first = optionsFor("first");
  first.full = true;
  first.skipped = {{7, 100}};
  run(first);
  MapBagOptions second = optionsFor("second");
  second.map = fileOf("first");
  second.skipped = {{0, 6}};
  run(second);
  for (const char* file : {"map_edges.ply", "map.edgevox"}) {
    EXPECT_EQ(contentOf(folder_ / "whole" / file), contentOf(folder_ / "second" / file)) << file;
  }
  const std::string whole = contentOf(folder_ / "whole" / "trajectory.tum");
  const std::string rest = contentOf(folder_ / "second" / "trajectory.tum");
  ASSERT_GT(whole.size(), rest.size());
  EXPECT_EQ(whole.substr(whole.size() - rest.size()), rest);
  EXPECT_EQ(5U, readTum(folder_ / "second" / "trajectory.tum").size());
}

TEST_F(MapBagMaps, cloudsAreLocatedInAMapThatStays) {
  run(optionsFor("mapped"));
  const std::string before = contentOf(fileOf("mapped"));
  MapBagOptions options = optionsFor("located");
  options.localize = fileOf("mapped");
  options.reference = (folder_ / "mapped" / "trajectory.tum").string();
  const YAML::Node summary = run(options);
  EXPECT_EQ(summary["tracked"].as<int>(), kSweeps);
  EXPECT_LT(summary["ape_rmse_m"].as<double>(), 0.01);
  EXPECT_FALSE(summary["map_bytes"]);
  EXPECT_EQ(before, contentOf(fileOf("mapped")));
  EXPECT_FALSE(fs::exists(folder_ / "located" / "map.edgevox"));
}

TEST_F(MapBagMaps, theFirstCloudIsLookedForWhereTheOptionTells) {
  run(optionsFor("mapped"));
  constexpr int kSkipped = kSweeps / 2;
  const Trajectory mapped = readTum(folder_ / "mapped" / "trajectory.tum");
  const Eigen::Vector3d at = mapped.at(kSkipped).pose.translation();
  for (const double off : {0.8, 500.0}) {
    MapBagOptions options = optionsFor("located");
    options.localize = fileOf("mapped");
    options.reference = (folder_ / "mapped" / "trajectory.tum").string();
    options.skipped = {{0, kSkipped - 1}};
    options.start = Pose(Eigen::Translation3d(at.x() + off, at.y(), at.z()));
    const YAML::Node summary = run(options);
    EXPECT_EQ(summary["tracked"].as<int>(), kSweeps - kSkipped);
    EXPECT_LT(summary["ape_rmse_m"].as<double>(), 0.03);  // the first one not deskewed
  }
}

TEST_F(MapBagMaps, theParametersAreThoseOfTheFile) {
  MapBagOptions first = optionsFor("first");
  first.full = true;
  first.settings = {"map/anchors=9"};
  run(first);
  MapBagOptions second = optionsFor("second");
  second.map = fileOf("first");
  second.skipped = {{0, kSweeps - 2}};  // only the last one is later than the map
  EXPECT_NE(std::string::npos, contentOf(folder_ / "first" / "config.yaml").find("anchors: 9"));
  second.settings = {"map/anchors=8"};
  EXPECT_THROW(run(second), ConfigError);
}

TEST_F(MapBagMaps, aMapIsNotReplacedByARunThatOnlyLocates) {
  run(optionsFor("mapped"));
  MapBagOptions options = optionsFor("mapped");
  options.localize = fileOf("mapped");
  EXPECT_THROW(run(options), UsageError);
  EXPECT_TRUE(fs::exists(fileOf("mapped")));
}

TEST_F(MapBagMaps, mappingDoesNotGoOnInACompactFileNorInADamagedOne) {
  run(optionsFor("mapped"));
  MapBagOptions options = optionsFor("more");
  options.map = fileOf("mapped");
  EXPECT_THROW(run(options), MapFileError);
  std::ofstream(fileOf("mapped"), std::ios::app) << "x";
  options.map.clear();
  options.localize = fileOf("mapped");
  EXPECT_THROW(run(options), MapFileError);
}

}  // namespace
}  // namespace edgevox
