// SPDX-License-Identifier: BSD-3-Clause
// edgevox/Mapper: what save_map writes, and what it refuses.
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>
#include <std_srvs/Trigger.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "edgevox/io/atomic_file.hpp"
#include "edgevox/io/map_file.hpp"
#include "edgevox/io/trajectory_io.hpp"
#include "edgevox/mapping/mapper.hpp"
#include "ros/conversions/voxel_scan_message.hpp"
#include "ros/mapper_fixture.hpp"
#include "support/sweeps.hpp"
#include "support/temp_folder.hpp"

namespace edgevox::test {
namespace {

namespace fs = std::filesystem;

std::string contentOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

size_t linesOf(const fs::path& file) {
  const std::string content = contentOf(file);
  return static_cast<size_t>(std::count(content.begin(), content.end(), '\n'));
}

std::vector<Eigen::Vector3f> pointsOfPcd(const fs::path& file) {
  pcl::PointCloud<pcl::PointXYZ> cloud;
  EXPECT_EQ(0, pcl::io::loadPCDFile(file.string(), cloud));
  std::vector<Eigen::Vector3f> points;
  for (const auto& p : cloud) points.emplace_back(p.x, p.y, p.z);
  return points;
}

class SaveTest : public MapperTest {
 protected:
  void expectTrajectory(const fs::path& file) {
    const Trajectory trajectory = readTum(file);
    ASSERT_TRUE(odometry_.waitFor(trajectory.size()));
    const auto odometry = odometry_.messages();
    ASSERT_EQ(odometry.size(), trajectory.size());
    for (size_t i = 0; i < odometry.size(); ++i) {
      EXPECT_NEAR(odometry[i]->header.stamp.toSec(), trajectory[i].stamp, 1e-6);
      const auto& p = odometry[i]->pose.pose.position;
      const auto& q = odometry[i]->pose.pose.orientation;
      const Pose& pose = trajectory[i].pose;
      EXPECT_LT((pose.translation() - Eigen::Vector3d(p.x, p.y, p.z)).norm(), 1e-8);
      EXPECT_LT(
          Eigen::Quaterniond(pose.linear()).angularDistance(Eigen::Quaterniond(q.w, q.x, q.y, q.z)),
          1e-8);
    }
  }

  /// No folder is written to, and the answer has these words.
  void expectRefused(const std::string& folder, const std::vector<std::string>& words) {
    const auto answer = save(folder);
    EXPECT_FALSE(answer.success);
    EXPECT_TRUE(hasWords(answer.message, words)) << answer.message;
  }

  TempFolder folder_;
};

TEST_F(SaveTest, WritesTheFilesOfMapBag) {
  Config config;
  config.map.min_hits = 3;
  config.edges.map.support = 0.4;
  setParameter("mapper", "map/min_hits", 3);
  setParameter("mapper", "edges/map_support", 0.4);
  setParameter("mapper", "threads", 2);
  start();
  Scans sent;
  for (VoxelScanStamped scan : scans()) {
    scan.settings.clear();
    scan.refused = 2;
    scan.dropped = 1;
    sent.push_back(scan);
  }
  sent.push_back(randomScan(stampAfter(kScans - 1, 0.1)));
  sent.back().settings.clear();
  map(sent);
  const fs::path out = folder_ / "maps/today";
  const auto answer = save(out.string());
  ASSERT_TRUE(answer.success) << answer.message;

  Mapper mapper(config);
  for (const VoxelScanStamped& scan : sent) mapper.process(fromMessage(scan));
  mapper.finishLabels();
  const auto points = centroidsOf(mapper.map(), mapper.map().edgeVoxels());
  ASSERT_GT(points.size(), 100U);
  EXPECT_TRUE(hasWords(answer.message, {std::to_string(points.size()) + " edge voxels",
                                        std::to_string(kScans) + " poses", out.string()}));
  EXPECT_TRUE(points == pointsOfPcd(out / "map_edges.pcd"));
  const std::string ply = contentOf(out / "map_edges.ply");
  const size_t bytes = 12 * points.size();
  ASSERT_GT(ply.size(), bytes);
  EXPECT_EQ(0, std::memcmp(points.data(), ply.data() + ply.size() - bytes, bytes));
  EXPECT_EQ(yamlText(config), contentOf(out / "config.yaml"));
  expectTrajectory(out / "trajectory.tum");
  EXPECT_EQ(1 + sent.size(), linesOf(out / "timings.csv"));
  const YAML::Node summary = YAML::LoadFile((out / "summary.json").string());
  EXPECT_EQ(sent.size(), summary["scans"].as<size_t>());
  EXPECT_EQ(size_t{kScans}, summary["tracked"].as<size_t>());
  EXPECT_EQ(1U, summary["lost"].as<size_t>());
  EXPECT_EQ(points.size(), summary["edge_voxels"].as<size_t>());
  EXPECT_EQ("time", summary["time_field"].as<std::string>());
}

TEST_F(SaveTest, WritesToTheParametersFolderIfNoneIsGiven) {
  const fs::path out = folder_ / "by_default";
  setParameter("mapper", "output", out.string());
  start();
  map(firstScans(3));
  EXPECT_TRUE(save("").success);
  EXPECT_EQ(3U, linesOf(out / "trajectory.tum"));
}

TEST_F(SaveTest, AnEmptyMapReplacesNone) {
  const fs::path out = folder_ / "kept";
  setParameter("mapper", "output", out.string());
  start();
  expectRefused("", {"the map is empty", "stays as it is"});  // before the first scan
  map(firstScans(3));
  EXPECT_TRUE(save("").success);
  const std::string before = contentOf(out / "map.edgevox");
  call("reset", std_srvs::Trigger());
  expectRefused("", {"the map is empty", "stays as it is"});
  EXPECT_TRUE(before == contentOf(out / "map.edgevox"));
}

TEST_F(SaveTest, InTheMiddleDoesNotChangeTheTrajectory) {
  start();
  map(firstScans(kMiddle));
  ASSERT_TRUE(save(folder_.path().string()).success);
  EXPECT_EQ(kMiddle, linesOf(folder_ / "trajectory.tum"));
  for (size_t i = kMiddle; i < scans().size(); ++i) send(scans()[i]);
  ASSERT_TRUE(save(folder_.path().string()).success);  // while they are mapped
  EXPECT_GE(linesOf(folder_ / "trajectory.tum"), kMiddle);
  ASSERT_TRUE(allReported());
  ASSERT_TRUE(save(folder_.path().string()).success);
  expectOdometry(walkPoses());
  expectTrajectory(folder_ / "trajectory.tum");
}

TEST_F(SaveTest, AFullMapGoesOnAsTheMapperDoes) {
  setParameter("mapper", "map_frame", std::string("world"));
  start();
  map(firstScans(kMiddle));
  ASSERT_TRUE(save((folder_ / "compact").string()).success);
  ASSERT_TRUE(save((folder_ / "full").string(), true).success);
  EXPECT_EQ(MapContent::kCompact, MapFile::read(folder_ / "compact/map.edgevox").head().content);
  const MapFile file = MapFile::read(folder_ / "full/map.edgevox");
  EXPECT_EQ("world", file.head().map_frame);
  ASSERT_EQ(MapContent::kFull, file.head().content);
  Mapper resumed(file.config());
  file.restore(resumed);
  Mapper whole{Config{}};
  for (size_t i = 0; i < scans().size(); ++i) {
    const ScanResult expected = whole.process(fromMessage(scans()[i]));
    if (i < kMiddle) continue;
    const ScanResult found = resumed.process(fromMessage(scans()[i]));
    EXPECT_TRUE(sameBits(expected.T_map_sensor, found.T_map_sensor)) << i;
  }
}

TEST_F(SaveTest, SavesNothingWhereTheMapToGoOnWithCannotBeRead) {
  Mapper mapper{Config{}};
  for (const VoxelScanStamped& scan : firstScans(3)) mapper.process(fromMessage(scan));
  mapper.finishLabels();
  const fs::path file = folder_ / "map.edgevox";
  writeFile(file, mapFileBytes(MapContent::kCompact, mapper, Config{}, "map"));
  const std::string before = contentOf(file);
  setParameter("mapper", "map_file", file.string());
  setParameter("mapper", "output", folder_.path().string());
  start();
  expectService("load_map");
  map(firstScans(2));
  EXPECT_EQ("no_map", lastStatus());
  EXPECT_TRUE(tells("mapper", Status::ERROR, {"is compact", "save a full one"}));
  expectRefused("", {"nothing is saved", "is compact"});
  EXPECT_TRUE(before == contentOf(file));
  call("reset", std_srvs::Trigger());
  map({scans()[2]});
  EXPECT_EQ("first", lastStatus());
}

TEST_F(SaveTest, SaysWhatIsWrongWithAFolder) {
  start();
  map(firstScans(2));
  expectRefused("", {"no folder", "parameter output"});
  expectRefused("edgevox_maps", {"'edgevox_maps' is not absolute", "begin it with /"});
  EXPECT_FALSE(fs::exists("edgevox_maps"));
  std::ofstream(folder_ / "file") << "not a folder";
  const std::string in_a_file = (folder_ / "file").string() + "/maps";
  expectRefused(in_a_file, {in_a_file, "choose another"});
  EXPECT_TRUE(logs(rosgraph_msgs::Log::WARN, {resolved("mapper"), "no folder"}));
  map({scans()[2]});
  expectOdometry({walkPoses().begin(), walkPoses().begin() + 3});
}

}  // namespace
}  // namespace edgevox::test

int main(int argc, char** argv) { return edgevox::test::runNodeletTests(argc, argv); }
