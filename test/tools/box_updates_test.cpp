// SPDX-License-Identifier: BSD-3-Clause
// What a display shows that is sent only the blocks that have changed.
#include "ros/conversions/box_updates.hpp"

#include <gtest/gtest.h>

#include "support/random.hpp"
#include "support/voxel_sets.hpp"
#include "tools/marker_display.hpp"

namespace edgevox::test {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr double kSize = 0.5;  // [m]

std_msgs::Header header() {
  std_msgs::Header header;
  header.frame_id = "map";
  header.stamp = ros::Time(3, 4);
  return header;
}

class BoxUpdatesTest : public ::testing::Test {
 protected:
  /// The display gets what there is to send.
  MarkerArray update() {
    const MarkerArray array = updates_.next(BitGrid<16>(voxels_), kSize, header());
    for (const Marker& marker : array.markers) EXPECT_EQ(header(), marker.header);
    display_.show(array);
    return array;
  }

  void expectAllShown() const {
    std::map<MarkerDisplay::Point, float> shown = display_.points();
    EXPECT_EQ(voxels_.voxelCount(), shown.size());
    voxels_.forEach([&](const VoxelIndex& v) {
      const Eigen::Vector3d c = voxelCentre(v, kSize);
      EXPECT_EQ(1U, shown.count({c.x(), c.y(), c.z()}));
    });
  }

  void setRandomly(int count) {
    for (int i = 0; i < count; ++i) voxels_.set(random_.voxelIn(-30, 30));
  }

  Random random_{3};
  BitGrid<16> voxels_;
  BoxUpdates updates_;
  MarkerDisplay display_;
};

TEST_F(BoxUpdatesTest, ShowAllThatThereIs) {
  for (int step = 0; step < 40; ++step) {
    setRandomly(50);
    for (const VoxelIndex& v : voxelsOf(voxels_)) {
      if (random_.chance(0.2)) voxels_.reset(v);
    }
    update();
    expectAllShown();
  }
  for (const VoxelIndex& v : voxelsOf(voxels_)) voxels_.reset(v);
  update();
  EXPECT_EQ(0U, display_.markerCount());
}

TEST_F(BoxUpdatesTest, SendTheBlocksThatHaveChangedAndNoOthers) {
  for (int i = 0; i < 500; ++i) voxels_.set(random_.voxelIn(0, 99));
  EXPECT_EQ(Marker::DELETEALL, update().markers.front().action);
  EXPECT_TRUE(update().markers.empty());
  voxels_.set({50, 50, 50});
  voxels_.set({51, 50, 50});
  voxels_.set({500, 50, 50});
  MarkerArray array = update();
  ASSERT_EQ(2U, array.markers.size());
  EXPECT_EQ(Marker::ADD, array.markers[0].action);
  EXPECT_EQ(Marker::CUBE_LIST, array.markers[0].type);
  voxels_.reset({500, 50, 50});
  array = update();
  ASSERT_EQ(1U, array.markers.size());
  EXPECT_EQ(Marker::DELETE, array.markers[0].action);
  voxels_.set({50, 51, 50});
  voxels_.reset({50, 51, 50});
  EXPECT_TRUE(update().markers.empty()) << "it is as before";
}

TEST_F(BoxUpdatesTest, StartAnewForWhoHasNothing) {
  setRandomly(200);
  update();
  display_ = {};
  updates_.restart();
  EXPECT_EQ(Marker::DELETEALL, update().markers.front().action);
  expectAllShown();
  voxels_ = {};  // another map: its blocks have other numbers
  updates_.restart();
  setRandomly(100);
  update();
  expectAllShown();
}

TEST_F(BoxUpdatesTest, KeepColoursThatFitTheHeights) {
  for (int z = 0; z < 300; ++z) {
    for (int x = 0; x < 3; ++x) voxels_.set({x, 0, z});
    update();
    float darker = 0;
    for (const auto& [point, brightness] : display_.points()) {
      if (std::get<0>(point) != kSize / 2) continue;
      EXPECT_GE(brightness, darker) << z;
      darker = brightness;
    }
    if (z > 20) EXPECT_GT(darker, 1.7F) << "the highest is yellow";
  }
}

}  // namespace
}  // namespace edgevox::test
