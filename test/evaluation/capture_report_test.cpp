// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/capture_report.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "evaluation/pcl_registration.hpp"
#include "evaluation/tracker_registration.hpp"
#include "table_rows.hpp"

namespace edgevox {
namespace {

using test::number;
using test::Row;
using test::rowsOf;

void ignore(const std::string&) {}

Config coarse() {
  Config config;
  config.voxel_size = 0.4;
  return config;
}

class CaptureSceneTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ =
        new CaptureScene(makeScene("building:16", simulatedStream("building:16"), 12, coarse()));
  }
  static void TearDownTestSuite() { delete scene_; }

  /// Captures of the last probe from near its pose.
  static CaptureCounts near(const RegistrationFor& make) {
    const CaptureProbe& probe = scene_->probes.back();
    return capture(probe, disturbedBy(0.1, 1.0), 2, make(probe));
  }

  static CaptureScene* scene_;
};
CaptureScene* CaptureSceneTest::scene_ = nullptr;

TEST_F(CaptureSceneTest, ProbesAreScansThatTheMapDoesNotHave) {
  EXPECT_EQ(scene_->map.scans(), 6U);
  EXPECT_EQ(scene_->probes.size(), 6U);
  for (const CaptureProbe& probe : scene_->probes) {
    for (const ScanVoxel& voxel : probe.scan.voxels) ASSERT_EQ(voxel.time_offset, 0.0F);
  }
}

TEST_F(CaptureSceneTest, AllFindWhatIsNear) {
  const Config config = coarse();
  EXPECT_EQ(near(firstScanTracker(*scene_, config)).right, 2U);
  EXPECT_EQ(near(experiencedTracker(*scene_, config)).right, 2U);
  EXPECT_EQ(near(pclGicp(*scene_, config)).right, 2U);
  EXPECT_EQ(near(pclNdt(*scene_, config)).right, 2U);
}

TEST_F(CaptureSceneTest, TheTrackerRefusesWhereThereIsNoMap) {
  const CaptureProbe& probe = scene_->probes.back();
  const auto counts =
      capture(probe, disturbedBy(500.0, 0.0), 2, experiencedTracker(*scene_, coarse())(probe));
  EXPECT_EQ(counts.refused, 2U);
}

TEST_F(CaptureSceneTest, TableDoesNotDependOnThreads) {
  const auto rows = [&](int threads) {
    CaptureOptions options;
    options.trials = 6;
    options.threads = threads;
    options.config = coarse();
    CaptureTable table(options);
    table.add(*scene_, ignore);
    return rowsOf(table.table());
  };
  const auto one = rows(1);
  const auto two = rows(2);
  ASSERT_EQ(one.size(), 12U);
  for (size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(number(one[i], "trials"), 6.0);
    EXPECT_NEAR(number(one[i], "right") + number(one[i], "refused") + number(one[i], "wrong"),
                100.0, 1e-3);
    for (const char* column : {"registration", "right", "refused", "wrong"}) {
      EXPECT_EQ(one[i].at(column), two[i].at(column)) << i << " " << column;
    }
  }
}

TEST(CaptureScene, ProbesOfALongRecordingAreSpread) {
  const ScanStream many = [](size_t most, const VisitScan& visit) {
    const std::vector<Eigen::Vector3f> points = {{1.0F, 0.0F, 0.0F}, {0.0F, 2.0F, 0.0F}};
    for (size_t i = 0; i < most; ++i) {
      Pose pose = Pose::Identity();
      pose.translation().x() = static_cast<double>(i);
      visit(viewOf(points, static_cast<double>(i), "lidar"), [&](double) { return pose; });
    }
  };
  const CaptureScene scene = makeScene("many", many, 300, coarse());
  EXPECT_EQ(scene.map.scans(), 150U);
  ASSERT_EQ(scene.probes.size(), 38U);  // every fourth of 150
  for (size_t i = 0; i < scene.probes.size(); ++i) {
    EXPECT_EQ(scene.probes[i].T_map_sensor.translation().x(), 8.0 * static_cast<double>(i) + 1.0);
    EXPECT_EQ(scene.probes[i].scan.voxels.size(), 2U);
  }
  EXPECT_THROW(makeScene("many", many, 1, coarse()), std::invalid_argument);
}

}  // namespace
}  // namespace edgevox
