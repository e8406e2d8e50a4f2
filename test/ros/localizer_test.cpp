// SPDX-License-Identifier: BSD-3-Clause
// edgevox/Localizer: where the sensor is in a saved map, from where it starts, and what it is
// asked.
#include <edgevox/LoadMap.h>
#include <geometry_msgs/PoseArray.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <std_srvs/Trigger.h>
#include <visualization_msgs/MarkerArray.h>

#include <filesystem>
#include <limits>

#include "edgevox/io/atomic_file.hpp"
#include "edgevox/io/map_file.hpp"
#include "edgevox/mapping/localizer.hpp"
#include "edgevox/mapping/mapper.hpp"
#include "edgevox/scan/voxelizer.hpp"
#include "ros/conversions/pose_messages.hpp"
#include "ros/conversions/voxel_scan_message.hpp"
#include "ros/mapper_fixture.hpp"
#include "ros/simulated_scans.hpp"
#include "sim/parts.hpp"
#include "support/mapped_world.hpp"
#include "support/sweeps.hpp"
#include "support/temp_folder.hpp"
#include "tools/map_bag_fixture.hpp"

namespace edgevox::test {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using geometry_msgs::PoseWithCovarianceStamped;
using rosgraph_msgs::Log;

/// A room of 8 x 6 m and, 3.2 m above it, one of 6 x 4 m.
sim::World twoStoreys() {
  sim::Solids solids;
  const auto room = [&](double x, double y, double z) {
    sim::addBox(solids, {0, 0, z, 0}, {-4.2, -3.2, -0.2}, {4.2, 3.2, 0.0}, 0.5);
    sim::addWall(solids, {-x, -y, x, -y, 0.2, z, z + 2.8, {}}, 0.5);
    sim::addWall(solids, {-x, y, x, y, 0.2, z, z + 2.8, {}}, 0.5);
    sim::addWall(solids, {-x, -y, -x, y, 0.2, z, z + 2.8, {}}, 0.5);
    sim::addWall(solids, {x, -y, x, y, 0.2, z, z + 2.8, {}}, 0.5);
  };
  room(4, 3, -1.4);
  sim::addTable(solids, {1.5, 1.5, -1.4, 0.3}, 1.6, 0.8);
  sim::addShelf(solids, {-3.5, -1.0, -1.4, 0.0}, 1.2, 2.0);
  room(3, 2, 1.8);
  sim::addBox(solids, {0, 0, 4.6, 0}, {-4.2, -3.2, 0.0}, {4.2, 3.2, 0.2}, 0.5);
  sim::addShelf(solids, {2.0, -1.6, 1.8, 1.57}, 1.2, 2.0);
  sim::addTable(solids, {-1.5, 0.8, 1.8, 1.0}, 1.6, 0.8);
  return sim::World(solids);
}

class LocalizerTest : public MapperTest {
 protected:
  static const sim::World& rooms() {
    static const sim::World world = twinRooms();
    return world;
  }

  /// The file of a map.
  std::string saved(const std::string& name, const std::string& bytes) const {
    const fs::path file = folder_ / name;
    writeFile(file, bytes);
    return file.string();
  }
  /// Of the walk.
  std::string walkMap(MapContent content, const Config& config = {}) const {
    Mapper mapper(config);
    for (const VoxelScanStamped& scan : scans()) mapper.process(fromMessage(scan));
    mapper.finishLabels();
    return saved("walk.edgevox", mapFileBytes(content, mapper, config, "map"));
  }
  std::string mapOf(const std::string& name, const sim::World& world,
                    const std::vector<Pose>& poses) const {
    const Config config;
    return saved(name, mapFileBytes(mapFrom(world, poses, config), config, "map", poses.size()));
  }
  std::string twinMap() const { return mapOf("twins.edgevox", rooms(), posesInTwinRooms()); }

  void startIn(const std::string& file) {
    setParameter("localizer", "map_file", file);
    start(100, "localizer");
    expectService("load_map");
  }

  /// Sends a scan and gives its status.
  std::string see(const sim::World& world, const Pose& T_world_sensor) {
    const VoxelScan scan = scanFrom(world, T_world_sensor, {}, ++seeds_);
    map({edgesOf(scan, ros::Time(100) + ros::Duration(0.1 * seeds_))});
    return lastStatus();
  }
  void expectSeen(const sim::World& world, const Pose& T_world_sensor) {
    const std::string status = see(world, T_world_sensor);
    EXPECT_TRUE(status == "tracked" || status == "fallback") << status;
    ASSERT_TRUE(odometry_.waitFor(++located_));
    const auto& p = odometry_.messages().back()->pose.pose.position;
    const Vector3d expected = T_world_sensor.translation();
    EXPECT_LT((Vector3d(p.x, p.y, p.z) - expected).norm(), 0.05) << expected.transpose();
  }

  void pointTo(const Pose& pose, const std::string& frame = "map") {
    if (!pointer_) {
      pointer_ = advertise<PoseWithCovarianceStamped>(resolved("initialpose"), 1);
      ASSERT_TRUE(eventually([&] { return pointer_.getNumSubscribers() > 0; }));
    }
    PoseWithCovarianceStamped message;
    message.header.frame_id = frame;
    message.pose.pose = toMessage(pose);
    publish(pointer_, message);
    ros::Duration(0.2).sleep();  // nothing tells that it has arrived
  }

  LoadMap::Response loadMap(const std::string& file) {
    LoadMap service;
    service.request.file = file;
    return call("load_map", service);
  }
  void expectRefused(const std::string& file, const std::vector<std::string>& words) {
    const auto answer = loadMap(file);
    EXPECT_FALSE(answer.success) << file;
    EXPECT_TRUE(hasWords(answer.message, words)) << answer.message;
  }
  std::string trigger(const std::string& service) {
    const auto answer = call(service, std_srvs::Trigger());
    EXPECT_TRUE(answer.success) << service;
    return answer.message;
  }

  const Pose in_first_ = poseOf({3.4, 5.2, 0.0}, 0.8);
  const Pose in_second_ = poseOf({15.4, 5.2, 0.0}, 0.8);
  const Pose in_hall_ = poseOf({20.0, 1.0, 0.0}, 0.3);
  TempFolder folder_;
  Listener<geometry_msgs::PoseArray> candidates_{resolved("candidates")};

 private:
  uint32_t seeds_ = 1000;
  size_t located_ = 0;
  ros::Publisher pointer_;
};

TEST_F(LocalizerTest, FollowsTheSensorAsTheCoreDoes) {
  for (const MapContent content : {MapContent::kCompact, MapContent::kFull}) {
    const std::string file = walkMap(content);
    const std::string before = contentOf(file);
    const size_t done = odometry_.count();
    const MapFile read = MapFile::read(file);
    Localizer localizer(read.config(), read.matchMap());
    std::vector<Pose> expected;
    for (const VoxelScanStamped& scan : scans()) {
      const ScanResult result = localizer.process(fromMessage(scan));
      ASSERT_TRUE(result.located());
      expected.push_back(result.T_map_sensor);
    }
    startIn(file);
    map(firstScans(1));
    ros::WallDuration(0.35).sleep();  // until TF has had the time to know the sensor's frame
    map({scans().begin() + 1, scans().end()});
    ASSERT_TRUE(odometry_.waitFor(done + expected.size()));
    for (size_t i = 0; i < expected.size(); ++i) {
      EXPECT_TRUE(same(expected[i], odometry_.messages()[done + i]->pose.pose)) << "pose " << i;
      const PoseDifference off = differenceOf(walkPoses()[i], expected[i]);
      EXPECT_LT(off.metres, 0.02) << i;
      EXPECT_LT(off.degrees, 0.2) << i;
    }
    EXPECT_TRUE(before == contentOf(file));
    EXPECT_EQ((done > 0 ? 2 : 1) * expected.size(), transformsTo("lidar").size());
    ASSERT_TRUE(unload("localizer"));
  }
}

TEST_F(LocalizerTest, ShowsItsMap) {
  const std::string file = walkMap(MapContent::kCompact);
  const MapFileHead head = MapFile::read(file).head();
  startIn(file);
  const Listener<sensor_msgs::PointCloud2> edges(resolved("map_edges"));
  const Listener<sensor_msgs::PointCloud2> occupied(resolved("map_occupied"));
  const Listener<visualization_msgs::MarkerArray> boxes(resolved("map_boxes_update"));
  ASSERT_TRUE(edges.waitFor(1) && occupied.waitFor(1) && boxes.waitFor(1));
  EXPECT_EQ(head.edge_voxels, edges.messages()[0]->width);
  EXPECT_EQ(head.occupied_voxels, occupied.messages()[0]->width);
  EXPECT_EQ("map", edges.messages()[0]->header.frame_id);
  EXPECT_TRUE(tells("localizer", [&](const Status& status) {
    return valueOf(status, "occupied voxels of the map") == std::to_string(head.occupied_voxels);
  }));
}

TEST_F(LocalizerTest, StartsWhereItIsPointedTo) {
  startIn(twinMap());
  EXPECT_EQ("ambiguous", see(rooms(), in_second_));
  ASSERT_TRUE(candidates_.waitFor(1));
  EXPECT_EQ(2U, candidates_.messages().back()->poses.size());
  EXPECT_TRUE(tells("localizer", Status::ERROR, {"one of 2 places that look alike"}));
  pointTo(in_second_, "odom");
  EXPECT_TRUE(logs(Log::WARN, {"initialpose", "frame 'odom'", "'map' is needed"}));
  EXPECT_EQ("ambiguous", see(rooms(), in_second_));
  Pose no_pose = in_second_;
  no_pose.translation().x() = std::numeric_limits<double>::quiet_NaN();
  pointTo(no_pose);
  EXPECT_EQ("ambiguous", see(rooms(), in_second_));
  pointTo(poseOf({16.6, 4.3, 0.1}, 0.28));  // 1.5 m and 30 degrees off
  expectSeen(rooms(), in_second_);
  EXPECT_TRUE(candidates_.messages().back()->poses.empty());
  expectSeen(rooms(), in_second_);
}

TEST_F(LocalizerTest, StartsWhereItsParameterSays) {
  setParameter("localizer", "initial_pose", std::string("16.6, 4.3, 0.1, 16"));
  startIn(twinMap());
  expectSeen(rooms(), in_second_);
}

TEST_F(LocalizerTest, FindsASensorThatWasCarriedToAnotherStorey) {
  const sim::World world = twoStoreys();
  std::vector<Pose> poses;
  for (const double z : {0.0, 3.2}) {
    for (const double x : {-2.0, 0.0, 2.0}) {
      for (const double y : {-1.2, 0.0, 1.2}) poses.push_back(poseOf({x, y, z}, x + y));
    }
  }
  setParameter("localizer", "localizer/search_after", 3);
  startIn(mapOf("storeys.edgevox", world, poses));
  const Pose below = poseOf({0.5, -0.4, 0.0}, 1.0);
  const Pose above = poseOf({-0.7, 0.6, 3.2}, -2.0);
  for (int i = 0; i < 3; ++i) expectSeen(world, below);
  for (int i = 0; i < 3; ++i) EXPECT_EQ("lost", see(world, above)) << i;
  EXPECT_EQ(3U, odometry_.count());
  EXPECT_TRUE(tells("localizer", Status::ERROR, {"LOST for 3 scans", "looked for in the map"}));
  for (int i = 0; i < 3; ++i) expectSeen(world, above);
  trigger("search");
  expectSeen(world, below);
}

TEST_F(LocalizerTest, PausesAndResumes) {
  startIn(twinMap());
  expectSeen(rooms(), in_hall_);
  trigger("pause");
  EXPECT_EQ("paused", see(rooms(), in_hall_));
  EXPECT_EQ("paused", see(rooms(), in_first_));
  EXPECT_TRUE(tells("localizer", Status::WARN, {"paused: call resume"}));
  EXPECT_EQ(1U, odometry_.count());
  EXPECT_TRUE(hasWords(trigger("resume"), {"near the last pose"}));
  expectSeen(rooms(), poseOf({21.5, 1.1, 0.0}, 0.8));
  trigger("pause");
  trigger("search");
  EXPECT_TRUE(hasWords(trigger("resume"), {"the next scan is used"}));
  expectSeen(rooms(), in_hall_);
}

TEST_F(LocalizerTest, KeepsItsMapIfItCannotLoadAnother) {
  startIn(twinMap());
  expectSeen(rooms(), in_hall_);
  expectRefused("map.edgevox", {"'map.edgevox' is not absolute"});
  expectRefused((folder_ / "none.edgevox").string(), {"none.edgevox", "check that it is a file"});
  std::string damaged = contentOf(twinMap());
  damaged[damaged.size() / 2] ^= 1;
  expectRefused(saved("damaged.edgevox", damaged), {"damaged.edgevox", "checksum"});
  Config other;
  other.voxel_size = 0.4;
  const std::string coarse =
      saved("coarse.edgevox", mapFileBytes(mapFrom(rooms(), {in_hall_}, other), other, "map", 1));
  expectRefused(coarse, {"coarse.edgevox", "voxel_size = 0.4", "which is 0.2 now"});
  const Config config;
  const std::string moved = saved(
      "moved.edgevox", mapFileBytes(mapFrom(rooms(), {in_hall_}, config), config, "world", 1));
  expectRefused(moved, {"moved.edgevox", "frame 'world', not in 'map'"});
  expectSeen(rooms(), in_hall_);
}

TEST_F(LocalizerTest, LoadsAnotherMap) {
  startIn(walkMap(MapContent::kCompact));
  see(rooms(), in_hall_);
  EXPECT_FALSE(reports_.messages().back()->located);
  EXPECT_TRUE(hasWords(reports_.messages().back()->text, {"2D Pose Estimate"}));
  const auto answer = loadMap(twinMap());
  EXPECT_TRUE(answer.success) << answer.message;
  EXPECT_TRUE(hasWords(answer.message, {"twins.edgevox", "occupied voxels", "edges"}));
  expectSeen(rooms(), in_hall_);
}

TEST_F(LocalizerTest, WaitsForAMap) {
  start(100, "localizer");
  expectService("load_map");
  EXPECT_EQ("no_map", see(rooms(), in_hall_));
  EXPECT_FALSE(call("search", std_srvs::Trigger()).success);
  EXPECT_TRUE(hasWords(reports_.messages().back()->text, {"call load_map"}));
  EXPECT_TRUE(tells("localizer", Status::ERROR, {"no map"}));
  EXPECT_TRUE(loadMap(twinMap()).success);
  expectSeen(rooms(), in_hall_);
}

TEST_F(LocalizerTest, TakesConfigurationAndFrameFromTheMap) {
  Config config;
  config.voxel_size = 0.4;
  config.map.coarsest_voxel = 12.8;
  Mapper mapper(config);
  Voxelizer voxelizer(config.voxelizer, config.voxel_size);
  for (const auto& cloud : walk().clouds) mapper.process(voxelizer.voxelize(viewOf(cloud)));
  mapper.finishLabels();
  const std::string file =
      saved("coarse.edgevox", mapFileBytes(MapContent::kCompact, mapper, config, "world"));
  setParameter("voxelizer", "map_file", file);
  ASSERT_TRUE(load("voxelizer"));
  startIn(file);
  const ros::Publisher points = advertise<sensor_msgs::PointCloud2>(resolved("points"), 10);
  ASSERT_TRUE(eventually([&] { return points.getNumSubscribers() > 0; }));
  publish(points, walk().clouds[3]);
  ASSERT_TRUE(odometry_.waitFor(1));
  EXPECT_EQ("world", odometry_.messages()[0]->header.frame_id);
}

}  // namespace
}  // namespace edgevox::test

int main(int argc, char** argv) { return edgevox::test::runNodeletTests(argc, argv); }
