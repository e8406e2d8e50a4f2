// SPDX-License-Identifier: BSD-3-Clause
// edgevox/Mapper: the map for listeners, and a new start by reset or reload.
#include <nav_msgs/Path.h>
#include <ros/service.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_srvs/Trigger.h>
#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include <map>
#include <memory>
#include <vector>

#include "edgevox/map/map_builder.hpp"
#include "edgevox/mapping/mapper.hpp"
#include "ros/conversions/voxel_scan_message.hpp"
#include "ros/mapper_fixture.hpp"
#include "ros/simulated_scans.hpp"
#include "tools/marker_display.hpp"

namespace edgevox::test {
namespace {

using Cloud = sensor_msgs::PointCloud2;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

/// The core's map after the scans.
MapBuilder mapOf(const Scans& scans) {
  Mapper mapper{Config{}};
  for (const VoxelScanStamped& scan : scans) mapper.process(fromMessage(scan));
  return mapper.map();
}

void expectHeader(const std_msgs::Header& header, const ros::Time& stamp) {
  EXPECT_EQ("map", header.frame_id);
  EXPECT_EQ(stamp, header.stamp);
}

void expectCloud(const std::vector<Eigen::Vector3f>& points, const ros::Time& stamp,
                 const Cloud& cloud) {
  expectHeader(cloud.header, stamp);
  EXPECT_GT(points.size(), 100U);
  EXPECT_TRUE(points == pointsOf(cloud));
}

void expectBoxes(const MapBuilder& map, const Marker& boxes) {
  EXPECT_EQ(Marker::CUBE_LIST, boxes.type);
  EXPECT_EQ(Marker::ADD, boxes.action);
  for (const double side : {boxes.scale.x, boxes.scale.y, boxes.scale.z}) {
    EXPECT_EQ(map.voxelSize(0), side);
  }
  ASSERT_EQ(map.edgeVoxels().voxelCount(), boxes.points.size());
  ASSERT_EQ(boxes.points.size(), boxes.colors.size());
  size_t i = 0;
  map.edgeVoxels().forEach([&](const VoxelIndex& v) {
    const auto& p = boxes.points[i++];
    EXPECT_EQ(voxelCentre(v, map.voxelSize(0)), Eigen::Vector3d(p.x, p.y, p.z));
  });
}

/// What a display of the updates shows is the map.
bool isShown(const MapBuilder& map, const Listener<MarkerArray>& updates) {
  MarkerDisplay display;
  for (const auto& message : updates.messages()) display.show(*message);
  const auto shown = display.points();
  bool all = shown.size() == map.edgeVoxels().voxelCount();
  map.edgeVoxels().forEach([&](const VoxelIndex& v) {
    const Eigen::Vector3d c = voxelCentre(v, map.voxelSize(0));
    all = all && shown.count({c.x(), c.y(), c.z()}) == 1;
  });
  return all;
}

/// From dark blue to yellow with the height.
void expectColoursByHeight(const Marker& boxes) {
  std::map<double, double> red_and_green;
  for (size_t i = 0; i < boxes.points.size(); ++i) {
    const auto& colour = boxes.colors[i];
    const double bright = static_cast<double>(colour.r + colour.g);
    const auto [entry, is_new] = red_and_green.emplace(boxes.points[i].z, bright);
    EXPECT_TRUE(is_new || entry->second == bright);
  }
  EXPECT_GT(red_and_green.rbegin()->second, red_and_green.begin()->second + 1.0);
}

class MapTest : public MapperTest {
 protected:
  MapTest() { setParameter("mapper", "map_period", 0.1); }

  /// A new listener to each topic must get the map after these scans.
  void expectMap(const Scans& scans) {
    const MapBuilder map = mapOf(scans);
    const ros::Time stamp = scans.back().header.stamp;
    const Listener<Cloud> edges(resolved("map_edges"));
    const Listener<Cloud> occupied(resolved("map_occupied"));
    const Listener<Marker> boxes(resolved("map_boxes"));
    ASSERT_TRUE(edges.waitFor(1) && occupied.waitFor(1) && boxes.waitFor(1));
    expectCloud(centroidsOf(map, map.edgeVoxels()), stamp, *edges.messages()[0]);
    expectCloud(centroidsOf(map, map.hitVoxels()), stamp, *occupied.messages()[0]);
    expectHeader(boxes.messages()[0]->header, stamp);
    expectBoxes(map, *boxes.messages()[0]);
    expectColoursByHeight(*boxes.messages()[0]);
  }
};

TEST_F(MapTest, ComesWithTheEdgesOfEveryLocatedScan) {
  start();
  const Listener<Cloud> edges(resolved("scan_edges"));
  Scans sent = firstScans(kMiddle);
  sent.push_back(randomScan(stampAfter(kMiddle - 1, 0.1)));
  map(sent);
  ASSERT_TRUE(edges.waitFor(kMiddle));
  Mapper mapper{Config{}};
  for (size_t i = 0; i < kMiddle; ++i) {
    mapper.process(fromMessage(sent[i]));
    const auto expected = mapper.recentEdges().edgeCentroids();
    expectCloud(expected, sent[i].header.stamp, *edges.messages()[i]);
  }
  EXPECT_EQ(kMiddle, edges.count()) << "the last one is lost";
}

TEST_F(MapTest, ReachesLateListenersWhole) {
  start();
  map(scans());
  expectMap(scans());
  expectMap(scans());  // from the latch: the topics have had listeners before
}

TEST_F(MapTest, FollowsForThoseWhoStay) {
  start();
  const Listener<Cloud> edges(resolved("map_edges"));
  map(firstScans(kMiddle));
  const auto is = [&](const MapBuilder& wanted) {
    const auto points = centroidsOf(wanted, wanted.edgeVoxels());
    return eventually(
        [&] { return edges.count() > 0 && pointsOf(*edges.messages().back()) == points; });
  };
  EXPECT_TRUE(is(mapOf(firstScans(kMiddle))));
  map({scans().begin() + kMiddle, scans().end()});
  EXPECT_TRUE(is(mapOf(scans())));
  const size_t so_far = edges.count();
  map({randomScan(stampAfter(kScans - 1, 0.1))});  // which does not change the map
  const Listener<Cloud> other(resolved("map_occupied"));
  EXPECT_TRUE(other.waitFor(1));  // a period has passed
  EXPECT_EQ(so_far, edges.count());
}

TEST_F(MapTest, IsShownByUpdates) {
  using Updates = Listener<MarkerArray>;
  start();
  auto updates = std::make_unique<Updates>(resolved("map_boxes_update"));
  map(firstScans(kMiddle));
  ASSERT_TRUE(eventually([&] { return isShown(mapOf(firstScans(kMiddle)), *updates); }));
  const size_t so_far = updates->count();
  map({scans().begin() + kMiddle, scans().end()});
  EXPECT_TRUE(eventually([&] { return isShown(mapOf(scans()), *updates); }));
  EXPECT_NE(Marker::DELETEALL, updates->messages()[so_far]->markers.front().action);

  updates.reset();
  updates = std::make_unique<Updates>(resolved("map_boxes_update"));
  EXPECT_TRUE(eventually([&] { return isShown(mapOf(scans()), *updates); })) << "joined late";
  call<std_srvs::Trigger>("reset");
  EXPECT_TRUE(eventually([&] { return isShown(MapBuilder(0.2, {}, {}, 1), *updates); }));
  map(firstScans(kMiddle));
  EXPECT_TRUE(eventually([&] { return isShown(mapOf(firstScans(kMiddle)), *updates); }));
}

TEST_F(MapTest, IsGoneAfterAResetAndTheTrajectoryTheFirstAgain) {
  start();
  const Listener<Cloud> edges(resolved("map_edges"));
  const Listener<Marker> boxes(resolved("map_boxes"));
  const Listener<nav_msgs::Path> path(resolved("path"));
  Scans before = firstScans(kMiddle);
  before.push_back(randomScan(stampAfter(kMiddle, 0.0)));
  map(before);
  EXPECT_TRUE(eventually([&] { return edges.count() > 0 && boxes.count() > 0; }));
  const auto answer = call<std_srvs::Trigger>("reset");
  EXPECT_TRUE(answer.success);
  EXPECT_NE("", answer.message);
  const auto all_gone = [&] {
    return edges.messages().back()->width == 0 &&
           boxes.messages().back()->action == Marker::DELETE && path.count() > 0 &&
           path.messages().back()->poses.empty();
  };
  EXPECT_TRUE(eventually(all_gone));
  EXPECT_TRUE(tells("mapper", Status::OK, {"no scan yet"}));

  map(scans());  // their stamps begin before the last one
  std::vector<Pose> expected = walkPoses();
  expected.insert(expected.begin(), walkPoses().begin(), walkPoses().begin() + kMiddle);
  expectOdometry(expected);
  EXPECT_EQ("first", statusOf(before.size()));
  EXPECT_EQ(geometry_msgs::Twist(), odometry_.messages()[kMiddle]->twist.twist);
  expectMap(scans());
}

TEST_F(MapTest, IsNewAfterUnloadingAndLoading) {
  start();
  map(firstScans(kMiddle));
  const Listener<Cloud> edges(resolved("map_edges"));
  ASSERT_TRUE(edges.waitFor(1));
  EXPECT_TRUE(unload("mapper"));
  EXPECT_EQ(0U, voxels_.getNumSubscribers());
  EXPECT_FALSE(ros::service::exists(resolved("reset"), false));
  publish(voxels_, scans()[kMiddle]);  // to nobody
  ASSERT_TRUE(load("mapper"));
  map(scans());
  std::vector<Pose> expected = walkPoses();
  expected.insert(expected.begin(), walkPoses().begin(), walkPoses().begin() + kMiddle);
  expectOdometry(expected);
  expectMap(scans());
}

TEST_F(MapTest, CanBeUnloadedWhileScansWait) {
  for (int round = 0; round < 5; ++round) {
    start();
    for (const VoxelScanStamped& scan : scans()) publish(voxels_, scan);
    EXPECT_TRUE(eventually([&] { return reports_.count() > static_cast<size_t>(round); }));
    EXPECT_TRUE(unload("mapper"));
  }
}

}  // namespace
}  // namespace edgevox::test

int main(int argc, char** argv) { return edgevox::test::runNodeletTests(argc, argv); }
