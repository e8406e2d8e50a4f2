// SPDX-License-Identifier: BSD-3-Clause
#include "run/map_files.hpp"

#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>
#include <sys/resource.h>

#include <csignal>
#include <string>
#include <vector>

#include "edgevox/io/atomic_file.hpp"
#include "edgevox/map/map_builder.hpp"
#include "support/temp_folder.hpp"

namespace edgevox {
namespace {

using PclCloud = pcl::PointCloud<pcl::PointXYZ>;
using Points = std::vector<Eigen::Vector3f>;

void expectPoints(const PclCloud& cloud, const Points& points) {
  ASSERT_EQ(cloud.size(), points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(Eigen::Vector3f(cloud[i].getVector3fMap()), points[i]);
  }
}

TEST(MapFiles, pclReadsWhatIsWritten) {
  const test::TempFolder folder;
  const Points points = {{1, 2, 3}, {-0.5F, 1e-6F, 1e6F}, {0, 0, 0}};
  writePly(folder / "map.ply", points);
  writePcd(folder / "map.pcd", points);
  PclCloud ply;
  PclCloud pcd;
  ASSERT_EQ(pcl::io::loadPLYFile((folder / "map.ply").string(), ply), 0);
  ASSERT_EQ(pcl::io::loadPCDFile((folder / "map.pcd").string(), pcd), 0);
  expectPoints(ply, points);
  expectPoints(pcd, points);
}

TEST(MapFiles, mapWithoutPoints) {
  const test::TempFolder folder;
  writePly(folder / "map.ply", {});
  writePcd(folder / "map.pcd", {});
  pcl::PCLPointCloud2 header;
  pcl::PCDReader().readHeader((folder / "map.pcd").string(), header);  // PCL 1.11: -1 of 0 points
  EXPECT_EQ(header.width, 0U);
  EXPECT_EQ(header.fields.size(), 3U);
  EXPECT_GT(std::filesystem::file_size(folder / "map.ply"), 0U);
}

TEST(MapFiles, failuresAreReported) {
  const test::TempFolder folder;
  EXPECT_THROW(writePly(folder / "none" / "map.ply", {{1, 2, 3}}), FileError);
  EXPECT_THROW(writePcd(folder / "none" / "map.pcd", {{1, 2, 3}}), FileError);
}

/// No file of this process grows beyond some bytes.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit = {bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int) = SIG_DFL;
};

TEST(MapFiles, failuresHalfWayAreReportedWithTheirReason) {
  const test::TempFolder folder;
  const Points points(10000, Eigen::Vector3f(1, 2, 3));
  const FileSizeLimit limit(50000);
  for (const auto& [write, name] : {std::make_pair(writePly, "map.ply"), {writePcd, "map.pcd"}}) {
    try {
      write(folder / name, points);
      ADD_FAILURE() << name << " was written";
    } catch (const FileError& error) {
      const std::string text = error.what();
      const std::string begin = "cannot write '" + (folder / name).string() + "': ";
      EXPECT_EQ(text.find(begin), 0U) << text;
      EXPECT_NE(text.find_first_of(":;", begin.size()), begin.size()) << text;
    }
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(MapFiles, centroidsInTheOrderOfVoxels) {
  MapConfig config;
  config.confirm_within = 0;
  MapBuilder map(0.1, config, EdgeConfig(), 1);
  const std::vector<Eigen::Vector3d> centroids = {
      {0.05, 0.05, 0.35}, {0.95, 0.05, 0.05}, {0.07, 0.05, 0.05}, {0.05, 0.35, 0.05}};
  map.insert(centroids, Eigen::Vector3d(0, 0, 5));
  map.insert(centroids, Eigen::Vector3d(0, 0, 5));
  const Points points = centroidsOf(map, map.hitVoxels());
  ASSERT_EQ(points.size(), 4U);
  for (size_t i = 0; i < 4; ++i) {
    const size_t from[] = {2, 1, 3, 0};
    EXPECT_LT((points[i] - centroids[from[i]].cast<float>()).norm(), 1e-6F) << i;
  }
}

}  // namespace
}  // namespace edgevox
