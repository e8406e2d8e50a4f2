// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/scan_folder.hpp"

#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "edgevox/io/atomic_file.hpp"
#include "evaluation/recording.hpp"
#include "support/temp_folder.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;

constexpr size_t kAll = std::numeric_limits<size_t>::max();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

using Points = std::vector<Eigen::Vector3f>;

/// What a stream has shown of a scan.
struct Seen {
  double stamp;
  Points points;  // sensor frame
  TruePose truth;

  Pose pose() const { return truth(0.0); }
};

template <typename Coordinate>
Eigen::Vector3f pointAt(const CloudView& cloud, size_t i) {
  Eigen::Vector3f point;
  for (int axis = 0; axis < 3; ++axis) {
    Coordinate value;
    const size_t offset = cloud.xyz_offset[static_cast<size_t>(axis)];
    std::memcpy(&value, cloud.data + i * cloud.point_step + offset, sizeof value);
    point[axis] = static_cast<float>(value);
  }
  return point;
}

std::vector<Seen> seenOf(const ScanStream& stream, size_t most = kAll) {
  std::vector<Seen> all;
  stream(most, [&](const CloudView& cloud, const TruePose& truth) {
    EXPECT_EQ(cloud.height, 1U);
    EXPECT_EQ(cloud.row_step, cloud.width * cloud.point_step);
    EXPECT_FALSE(cloud.time.present);
    Seen seen{cloud.stamp, {}, truth};
    const bool wide = cloud.xyz_type == Scalar::kFloat64;
    for (size_t i = 0; i < cloud.width; ++i) {
      seen.points.push_back(wide ? pointAt<double>(cloud, i) : pointAt<float>(cloud, i));
    }
    all.push_back(seen);
  });
  return all;
}

void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

std::string floats(const std::vector<float>& values) {
  std::string bytes(values.size() * sizeof(float), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

pcl::PointCloud<pcl::PointXYZI> pclCloud(const Points& points) {
  pcl::PointCloud<pcl::PointXYZI> cloud;
  for (const Eigen::Vector3f& p : points) {
    pcl::PointXYZI point;
    point.x = p.x();
    point.y = p.y();
    point.z = p.z();
    point.intensity = 7.0F;
    cloud.push_back(point);
  }
  return cloud;
}

Eigen::Matrix3d matrix(std::initializer_list<double> rows) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.begin());
}

// The scene of all formats: the sensor stands at the map's origin, looking along x; then at
// (2.5, -0.5, 0), looking along y. There (1, 2, 3) of the sensor is (2.5 - 2, -0.5 + 1, 3).
const Points kFirst = {{1.0F, 2.0F, 3.0F}, {4.0F, -1.0F, 0.5F}};
const Points kSecond = {{1.0F, 2.0F, 3.0F}, {0.0F, -2.0F, -1.0F}};
const Points kFirstInMap = kFirst;
const Points kSecondInMap = {{0.5F, 0.5F, 3.0F}, {4.5F, -0.5F, -1.0F}};
constexpr const char* kTum = "3 0 0 0 0 0 0 1\n4 2.5 -0.5 0 0 0 0.70710678 0.70710678\n";

// A camera half a metre before the velodyne: x to the right, y down, z forward. It moves 2 m
// forward and turns to the left: its x axis then points where z did, its z axis to where -x was.
constexpr const char* kCalibration =
    "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: 0 -1 0 0 0 0 -1 0 1 0 0 -0.5\n";
constexpr const char* kCameraPoses = "1 0 0 0 0 1 0 0 0 0 1 0\n0 0 -1 0 0 1 0 0 1 0 0 2\n";

class ScanFolderTest : public ::testing::Test {
 protected:
  ScanStream stream(const fs::path& poses = "") const {
    return folderStream(folder_.path(), poses);
  }
  std::vector<Seen> read(const fs::path& poses = "") const { return seenOf(stream(poses)); }
  void write(const std::string& name, const std::string& text) const {
    edgevox::write(folder_ / name, text);
  }
  void writeBin(const std::string& name, const Points& points) const {
    std::vector<float> values;
    for (const Eigen::Vector3f& p : points) {
      values.insert(values.end(), {p.x(), p.y(), p.z(), 0.25F});
    }
    write(name, floats(values));
  }
  void writePcd(const std::string& name, const Points& points, bool binary = true) const {
    pcl::io::savePCDFile((folder_ / name).string(), pclCloud(points), binary);
  }
  void writeUos() const {
    write("scan003.3d", "# cm\n-200 300 100\n100 50 400\n");
    write("scan003.pose", "0 0 0\n0 0 0\n");
    write("scan004.3d", "-200 300 100\n200 -100 0\n");
    write("scan004.pose", "50 0 250\n0 -90 0\n\n");
  }
  void writeKitti() const {
    writeBin("velodyne/000000.bin", kFirst);
    writeBin("velodyne/000001.bin", kSecond);
    write("calib.txt", kCalibration);
    write("poses.txt", kCameraPoses);
    write("times.txt", "3.0\n4.0e+00\n");
  }
  void writePcds(bool binary) const {
    writePcd("a1.pcd", kFirst, binary);
    writePcd("a2.pcd", kSecond, binary);
    write("poses.tum", kTum);
  }

  void expectScene(const std::vector<Seen>& seen) const {
    ASSERT_EQ(seen.size(), 2U);
    const std::vector<Points> expected = {kFirstInMap, kSecondInMap};
    for (size_t scan = 0; scan < 2; ++scan) {
      EXPECT_NEAR(seen[scan].stamp, 3.0 + static_cast<double>(scan), 1e-12);
      ASSERT_EQ(seen[scan].points.size(), 2U);
      for (size_t i = 0; i < 2; ++i) {
        const Eigen::Vector3f in_map =
            (seen[scan].pose() * seen[scan].points[i].cast<double>()).cast<float>();
        EXPECT_LT((in_map - expected[scan][i]).norm(), 1e-5F) << scan << " " << i;
      }
    }
  }

  /// What `action` says when it throws an Error.
  template <typename Error, typename Action>
  static std::string faultOf(const Action& action) {
    try {
      action();
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing is wrong";
  }

  template <typename Error>
  void expectRefused(const std::vector<std::string>& words, const fs::path& poses = "") const {
    const std::string fault = faultOf<Error>([&] { read(poses); });
    for (const std::string& word : words) EXPECT_NE(fault.find(word), std::string::npos) << fault;
  }
  /// Already without reading a scan.
  template <typename Error>
  void expectRefusedAtOnce(const std::vector<std::string>& words,
                           const fs::path& poses = "") const {
    const std::string fault = faultOf<Error>([&] { stream(poses); });
    for (const std::string& word : words) EXPECT_NE(fault.find(word), std::string::npos) << fault;
  }

  test::TempFolder folder_;
};

TEST_F(ScanFolderTest, Uos) {
  writeUos();
  expectScene(read());
}

TEST_F(ScanFolderTest, Kitti) {
  writeKitti();
  expectScene(read());
}

TEST_F(ScanFolderTest, KittiWithoutSubfolderAndTimes) {
  writeKitti();
  for (const char* name : {"000000.bin", "000001.bin"}) {
    fs::rename(folder_ / "velodyne" / name, folder_ / name);
  }
  fs::remove(folder_ / "times.txt");
  fs::rename(folder_ / "poses.txt", folder_ / "00.txt");
  const auto seen = read(folder_ / "00.txt");
  ASSERT_EQ(seen.size(), 2U);
  EXPECT_EQ(seen[0].stamp, 0.0);
  EXPECT_EQ(seen[1].stamp, 0.1);
  EXPECT_EQ(seen[1].points, kSecond);
  EXPECT_LT((seen[1].pose().translation() - Eigen::Vector3d(2.5, -0.5, 0)).norm(), 1e-12);
}

TEST_F(ScanFolderTest, PcdAscii) {
  writePcds(false);
  expectScene(read());
}

TEST_F(ScanFolderTest, PcdBinary) {
  writePcds(true);
  expectScene(read());
}

TEST_F(ScanFolderTest, Ply) {
  for (const bool binary : {false, true}) {
    pcl::io::savePLYFile((folder_ / "a1.ply").string(), pclCloud(kFirst), binary);
    pcl::io::savePLYFile((folder_ / "a2.ply").string(), pclCloud(kSecond), binary);
    write("poses.txt", kTum);
    expectScene(read());
  }
}

TEST_F(ScanFolderTest, PcdOfDoublesBehindOtherFields) {
  write("1.pcd",
        "VERSION .7\nFIELDS t y x z\nSIZE 4 8 8 8\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\n"
        "VIEWPOINT 5 5 5 1 0 0 0\nPOINTS 2\nDATA ascii\n9 2 1 3\n9 -1 4 0.5\n");
  write("poses.tum", "3 0 0 0 0 0 0 1\n");
  EXPECT_EQ(read()[0].points, kFirst);
}

// Left-handed, x to the right, y up, z forward, a quarter turn about each axis. Here x is forward,
// y to the left, z up; columns are where these go.
TEST_F(ScanFolderTest, UosTurnsAboutEachAxis) {
  write("scan000.3d", "1 2 3\n");
  const auto rotation = [&](const std::string& angles) {
    write("scan000.pose", "0 0 0\n" + angles + "\n");
    return Eigen::Matrix3d(read()[0].pose().linear());
  };
  // About x, y goes to z: up goes forward, forward goes down.
  const Eigen::Matrix3d about_x = matrix({0, 0, 1, 0, 1, 0, -1, 0, 0});
  // About y, z goes to x: forward goes to the right, left goes forward.
  const Eigen::Matrix3d about_y = matrix({0, 1, 0, -1, 0, 0, 0, 0, 1});
  // About z, x goes to y: the right goes up, left goes down, up goes to the left.
  const Eigen::Matrix3d about_z = matrix({1, 0, 0, 0, 0, 1, 0, -1, 0});
  EXPECT_LT((rotation("90 0 0") - about_x).norm(), 1e-12);
  EXPECT_LT((rotation("0 90 0") - about_y).norm(), 1e-12);
  EXPECT_LT((rotation("0 0 90") - about_z).norm(), 1e-12);
  // EulerToMatrix4 multiplies in this order.
  EXPECT_LT((rotation("90 90 0") - about_x * about_y).norm(), 1e-12);
  EXPECT_LT((rotation("90 0 90") - about_x * about_z).norm(), 1e-12);
  EXPECT_LT((rotation("0 90 90") - about_y * about_z).norm(), 1e-12);
  EXPECT_GT((about_x * about_y - about_y * about_x).norm(), 1.0);
}

// The elements of EulerToMatrix4 for 30, 45 and 60 degrees: sx = 1/2, cx = r3/2, sy = cy = r2/2,
// sz = r3/2, cz = 1/2. For example the second row is sx sy cz + cx sz, cx cz - sx sy sz, -sx cy.
TEST_F(ScanFolderTest, UosTurnsAsEulerToMatrix4) {
  const double r2 = std::sqrt(2.0);
  const double r3 = std::sqrt(3.0);
  const double r6 = std::sqrt(6.0);
  const Eigen::Matrix3d uos = matrix({r2 / 4, -r6 / 4, r2 / 2,                     //
                                      r2 / 8 + 3.0 / 4, r3 / 4 - r6 / 8, -r2 / 4,  //
                                      r3 / 4 - r6 / 8, 3 * r2 / 8 + 1.0 / 4, r6 / 4});
  write("scan000.3d", "1 2 3\n");
  write("scan000.pose", "100 200 300\n30 45 60\n");
  const Pose pose = read()[0].pose();
  EXPECT_LT((pose.translation() - Eigen::Vector3d(3, -1, 2)).norm(), 1e-12);
  // (x, y, z) here is (-y, z, x) there.
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(-4, 0, 1)}) {
    const Eigen::Vector3d there = uos * Eigen::Vector3d(-p.y(), p.z(), p.x());
    const Eigen::Vector3d here(there.z(), -there.x(), there.y());
    EXPECT_LT((pose.linear() * p - here).norm(), 1e-12);
  }
}

TEST_F(ScanFolderTest, UosHeaderColumnsAndSpaces) {
  write("scan000.3d",
        "360 x 225\n# x y z\n\n  1e2\t+200  -3.5e1 17 red\r\n \n0 0 0\n# 1 2 3\n7 8 9");
  write("scan000.pose", "0 0 0\n0 0 0\n");
  const Points expected = {{-0.35F, -1, 2}, {0, 0, 0}, {0.09F, -0.07F, 0.08F}};
  const auto seen = read();
  ASSERT_EQ(seen[0].points.size(), 3U);
  for (size_t i = 0; i < 3; ++i) EXPECT_LT((seen[0].points[i] - expected[i]).norm(), 1e-6F);
}

TEST_F(ScanFolderTest, UosOfManyPoints) {
  std::string text;
  for (int i = 0; i < 5000; ++i) text += std::to_string(i) + " 0 100\n";
  write("scan000.3d", text);
  write("scan000.pose", "0 0 0\n0 0 0\n");
  const Points points = read()[0].points;
  ASSERT_EQ(points.size(), 5000U);
  EXPECT_LT((points[4999] - Eigen::Vector3f(1, -49.99F, 0)).norm(), 1e-5F);
}

TEST_F(ScanFolderTest, NumbersCountNotDigits) {
  for (const char* name : {"scan10", "scan9", "scan100", "scan011"}) {
    write(std::string(name) + ".3d", "1 2 3\n");
    write(std::string(name) + ".pose", "0 0 0\n0 0 0\n");
  }
  std::vector<double> stamps;
  for (const Seen& seen : read()) stamps.push_back(seen.stamp);
  EXPECT_EQ(stamps, (std::vector<double>{9, 10, 11, 100}));
}

TEST_F(ScanFolderTest, PcdsInNaturalOrderOfNames) {
  writePcd("b10.pcd", {{3, 0, 0}});
  writePcd("b2.pcd", {{2, 0, 0}});
  writePcd("a11.pcd", {{1, 0, 0}});
  write("t.tum", "5 0 0 0 0 0 0 1\n6 1 0 0 0 0 0 1\n7 2 0 0 0 0 0 1\n");
  const auto seen = read();
  ASSERT_EQ(seen.size(), 3U);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(seen[i].points[0].x(), static_cast<float>(i + 1));
    EXPECT_EQ(seen[i].stamp, static_cast<double>(5 + i));
    EXPECT_NEAR(seen[i].pose().translation().x(), static_cast<double>(i), 1e-12);
  }
}

TEST_F(ScanFolderTest, NamesAreStampsIfPosesAreOthers) {
  writePcd("12.5.pcd", {{2, 0, 0}});
  writePcd("12.25.pcd", {{1, 0, 0}});
  writePcd("13.pcd", {{3, 0, 0}});
  write("t.tum", "12.252 1 0 0 0 0 0 1\n12.5 2 0 0 0 0 0 1\n");
  const auto seen = read();
  ASSERT_EQ(seen.size(), 3U);
  EXPECT_EQ(seen[0].stamp, 12.25);
  EXPECT_EQ(seen[0].points[0].x(), 1.0F);
  EXPECT_EQ(seen[0].pose().translation().x(), 1.0);
  EXPECT_EQ(seen[1].pose().translation().x(), 2.0);
  EXPECT_EQ(seen[2].stamp, 13.0);
  EXPECT_FALSE(seen[2].truth);
}

TEST_F(ScanFolderTest, StopsAfterTheMostAndBeginsAgain) {
  writeUos();
  write("scan005.3d", "damaged\n");
  write("scan005.pose", "0 0 0\n0 0 0\n");
  const ScanStream scans = stream();
  EXPECT_EQ(seenOf(scans, 0).size(), 0U);
  EXPECT_EQ(seenOf(scans, 2).size(), 2U);
  EXPECT_EQ(seenOf(scans, 1)[0].stamp, 3.0);
  EXPECT_THROW(seenOf(scans, 3), FileError);
}

TEST_F(ScanFolderTest, HandsOnPointsThatAreNotFinite) {
  const auto expectOneNan = [](const std::vector<Seen>& seen) {
    ASSERT_EQ(seen[0].points.size(), 2U);
    EXPECT_FALSE(seen[0].points[0].allFinite());
    EXPECT_TRUE(seen[0].points[1].allFinite());
  };
  const Points points = {{1.0F, kNan, 3.0F}, {1.0F, 2.0F, 3.0F}};
  const auto inFolder = [&](const std::string& name) { return folder_ / name; };
  write("uos/scan0.3d", "nan 1 2\n1 2 3\n");
  write("uos/scan0.pose", "0 0 0\n0 0 0\n");
  expectOneNan(seenOf(folderStream(inFolder("uos"), "")));
  writeBin("kitti/0.bin", points);
  write("kitti/calib.txt", kCalibration);
  write("kitti/poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  expectOneNan(seenOf(folderStream(inFolder("kitti"), "")));
  write("pcd/t.tum", "1 0 0 0 0 0 0 1\n");
  for (const bool binary : {false, true}) {
    writePcd("pcd/0.pcd", points, binary);
    expectOneNan(seenOf(folderStream(inFolder("pcd"), "")));
  }
}

TEST_F(ScanFolderTest, RefusesFoldersOfNoneAndOfSeveralFormats) {
  expectRefusedAtOnce<std::invalid_argument>({folder_.path().string(), "no scans", "scanNNN.3d"});
  write("scans.3d", "1 2 3\n");  // is none
  fs::create_directory(folder_ / "scan000.3d");
  expectRefusedAtOnce<std::invalid_argument>({"no scans"});
  EXPECT_NE(faultOf<FileError>([&] { folderStream(folder_ / "none", ""); }).find("none"),
            std::string::npos);
  fs::remove(folder_ / "scan000.3d");
  writeUos();
  writePcds(true);
  expectRefusedAtOnce<std::invalid_argument>({folder_.path().string(), "scanNNN.3d, *.pcd"});
}

TEST_F(ScanFolderTest, RefusesDamagedUosPoses) {
  writeUos();
  expectRefusedAtOnce<std::invalid_argument>({"some.tum", "leave out"}, "some.tum");
  const std::string pose = (folder_ / "scan004.pose").string();
  const std::vector<std::pair<std::string, std::string>> damages = {
      {"50 0 250\n", "has 1 lines"},       {"", "has 0 lines"},
      {"50 0 250\n0 -90\n", "line 2"},     {"50 0 250\n0 nan 0\n", "line 2"},
      {"50 0 2x0\n0 -90 0\n", "line 1"},   {"50 inf 0\n0 -90 0\n", "line 1"},
      {"50 0 250\n0 -90 0 4\n", "line 2"}, {"50 0 250\n0 -90 0\n1 2 3\n", "has 3 lines"}};
  for (const auto& [text, fault] : damages) {
    write("scan004.pose", text);
    expectRefusedAtOnce<FileError>({pose, fault, "three angles"});
  }
  fs::remove(folder_ / "scan004.pose");
  expectRefusedAtOnce<FileError>({pose, "cannot be read"});
}

TEST_F(ScanFolderTest, RefusesDamagedUosScans) {
  writeUos();
  const std::string scan = (folder_ / "scan004.3d").string();
  const std::vector<std::pair<std::string, std::string>> damages = {
      {"1 2 3\n# note\n4 5\n6 7 8\n", "line 3: "},
      {"1 2\n3 4 5\n", "line 1: "},
      {"1 2 3\n1 2 3x\n", "line 2: "},
      {"1 2 3\n360 x 225\n", "line 2: "},
      {"1 2 3\n1,2,3\n", "line 2: "},
      {"a\nb\nc\nd\ne\nf\ng\nh\ni\nj\nk\n1 2 3\n", "line 11: "},
      {"", "no points"},
      {"360 x 225\n# no more\n", "no points"}};
  for (const auto& [text, fault] : damages) {
    write("scan004.3d", text);
    expectRefused<FileError>({scan, fault});
  }
  const ScanStream scans = stream();
  fs::remove(folder_ / "scan004.3d");
  EXPECT_NE(faultOf<FileError>([&] { seenOf(scans); }).find(scan), std::string::npos);
  write("scan4.3d", "1 2 3\n");
  write("scan04.3d", "1 2 3\n");
  write("scan4.pose", "0 0 0\n0 0 0\n");
  write("scan04.pose", "0 0 0\n0 0 0\n");
  expectRefusedAtOnce<FileError>({"scan04.3d", "scan4.3d"});
}

TEST_F(ScanFolderTest, RefusesDamagedKittiFiles) {
  const std::string identity = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  struct Damage {
    std::string file, text;
    std::vector<std::string> words;
  };
  const std::vector<Damage> damages = {
      {"velodyne/000001.bin", std::string(40, '\0'), {"40 bytes", "16 a point"}},
      {"velodyne/000001.bin", "", {"no points"}},
      {"calib.txt", "P0: 1 0 0 0 0 1 0 0 0 0 1 0\n", {"no line 'Tr:'"}},
      {"calib.txt", "Tr: 0 -1 0 0 0 0 -1 0 1 0 0\n", {"line 1: ", "12 finite numbers"}},
      {"calib.txt", "\nTr: 0 -1 0 0 0 0 -1 0 1 0 0 nan\n", {"line 2: ", "12 finite numbers"}},
      {"calib.txt", "Tr: 0 -1 0 0 0 0 -1 0 2 0 0 0\n", {"line 1: ", "no rotation"}},
      {"calib.txt", "Tr: 0 1 0 0 0 0 -1 0 1 0 0 0\n", {"line 1: ", "no rotation"}},  // mirrored
      {"poses.txt", identity, {"1 lines for 2 scans"}},
      {"poses.txt", identity + identity + identity, {"3 lines for 2 scans"}},
      {"poses.txt", identity + "1 0 0 0 0 1 0 0 0 0 1\n", {"line 2: ", "12 finite numbers"}},
      {"poses.txt", identity + "1 0 0 nan 0 1 0 0 0 0 1 0\n", {"line 2: ", "12 finite numbers"}},
      {"poses.txt", identity + "1 0 0 0 0 1 0 0 0 0 0 0\n", {"line 2: ", "no rotation"}},
      {"times.txt", "0\n", {"1 lines for 2 scans"}},
      {"times.txt", "0 1\n", {"line 1: ", "1 finite"}},
      {"times.txt", "1\n\n1\n", {"line 3: ", "not later"}}};
  for (Damage damage : damages) {
    writeKitti();
    write(damage.file, damage.text);
    damage.words.push_back((folder_ / damage.file).string());
    expectRefused<FileError>(damage.words);
  }
  for (const char* missing : {"calib.txt", "poses.txt"}) {
    writeKitti();
    fs::remove(folder_ / missing);
    expectRefusedAtOnce<FileError>({(folder_ / missing).string()});
  }
  writeKitti();
  expectRefusedAtOnce<FileError>({"none.txt"}, folder_ / "none.txt");
  write("velodyne/000001.bin", std::string(40, '\0'));
  expectRefusedAtOnce<FileError>({"000001.bin"});
  writeBin("velodyne/000001.bin", kSecond);
  const ScanStream scans = stream();
  fs::remove(folder_ / "velodyne/000001.bin");
  EXPECT_NE(faultOf<FileError>([&] { seenOf(scans); }).find("000001.bin"), std::string::npos);
}

TEST_F(ScanFolderTest, RefusesTrajectoriesThatDoNotFit) {
  writePcds(true);
  fs::remove(folder_ / "poses.tum");
  expectRefusedAtOnce<std::invalid_argument>({"holds 0 trajectories"});
  write("notes.txt", "scanned on a Monday\n");
  write("empty.txt", "# nothing\n");
  expectRefusedAtOnce<std::invalid_argument>({"holds 0 trajectories", "notes.txt, line 1"});
  write("one.txt", kTum);
  expectScene(read());
  write("other.tum", kTum);
  expectRefusedAtOnce<std::invalid_argument>({"holds 2 trajectories"});
  expectScene(read(folder_ / "other.tum"));
  expectRefusedAtOnce<FileError>({"none.tum"}, folder_ / "none.tum");
  write("other.tum", "3 0 0 0 0 0 0 1\n4 nan 0 0 0 0 0 1\n");
  expectRefusedAtOnce<TrajectoryError>({"other.tum, line 2"}, folder_ / "other.tum");
  write("other.tum", std::string(kTum) + "5 0 0 0 0 0 0 1\n");
  expectRefusedAtOnce<std::invalid_argument>({"a1.pcd", "no stamp", "3 poses for 2 scans"},
                                             folder_ / "other.tum");
  fs::rename(folder_ / "a1.pcd", folder_ / "30.pcd");
  fs::rename(folder_ / "a2.pcd", folder_ / "31.pcd");
  expectRefusedAtOnce<std::invalid_argument>({"30.pcd", "5 ms"}, folder_ / "other.tum");
}

TEST_F(ScanFolderTest, RefusesDamagedPcds) {
  const auto cut = [&](size_t bytes) {
    fs::resize_file(folder_ / "a2.pcd", fs::file_size(folder_ / "a2.pcd") - bytes);
  };
  const std::string file = (folder_ / "a2.pcd").string();
  writePcds(true);
  cut(8);
  expectRefused<FileError>({file});
  writePcds(false);
  cut(20);
  expectRefused<FileError>({file});
  write("a2.pcd", "no cloud\n");
  expectRefused<FileError>({file});
  write("a2.pcd",
        "VERSION .7\nFIELDS x y i\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\n"
        "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA ascii\n1 2 3\n");
  expectRefused<FileError>({file, "no field 'z'"});
  write("a2.pcd",
        "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F I\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\n"
        "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA ascii\n1 2 3\n");
  expectRefused<FileError>({file, "float32"});
  for (const char* data : {"ascii", "binary", "binary_compressed"}) {
    write("a2.pcd",
          "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 0\nHEIGHT 1\n"
          "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 0\nDATA " +
              std::string(data) + "\n");
    expectRefused<FileError>({file});
  }
  const ScanStream scans = stream();
  fs::remove(folder_ / "a2.pcd");
  EXPECT_NE(faultOf<FileError>([&] { seenOf(scans); }).find(file), std::string::npos);
}

TEST_F(ScanFolderTest, RefusesDamagedPlys) {
  write("poses.txt", "3 0 0 0 0 0 0 1\n");
  for (const bool binary : {false, true}) {
    pcl::io::savePLYFile((folder_ / "1.ply").string(), pclCloud(kFirst), binary);
    fs::resize_file(folder_ / "1.ply", fs::file_size(folder_ / "1.ply") - 40);
    expectRefused<FileError>({"1.ply"});
  }
  write("1.ply", "no cloud\n");
  expectRefused<FileError>({"1.ply"});
}

TEST_F(ScanFolderTest, IsOneOfTheInputs) {
  writeUos();
  expectScene(seenOf(streamOf(folder_.path().string(), "")));
  EXPECT_EQ(recordingName(folder_.path()), folder_.path().filename().string());
  EXPECT_EQ(recordingName(folder_.path().string() + "/"), folder_.path().filename().string());
  size_t simulated = 0;
  streamOf("corridor:16", "")(2, [&](const CloudView&, const TruePose&) { ++simulated; });
  EXPECT_EQ(simulated, 2U);
  EXPECT_THROW(streamOf("corridor:16", "some.tum"), std::invalid_argument);
}

TEST_F(ScanFolderTest, IsARecording) {
  for (int i = 0; i < 6; ++i) writePcd(std::to_string(i) + ".pcd", {{1.0F + i, 0, 0}});
  write("t.tum", "1 10 0 0 0 0 0 1\n2 20 0 0 0 0 0 1\n3 30 0 0 0 0 0 1\n4 40 0 0 0 0 0 1\n");
  write("5.pcd", "damaged, but not wanted\n");
  RecordingOptions options;
  options.input = folder_.path().string();
  options.every = 2;
  options.most = 2;
  const Recording recording = makeRecording(options);
  EXPECT_EQ(recording.without_pose, 1U);  // 0.pcd
  ASSERT_EQ(recording.scans.size(), 1U);
  const RecordedScan& scan = recording.scans[0];
  EXPECT_EQ(scan.view.stamp, 2.0);
  EXPECT_EQ(scan.view.data, scan.bytes.data());
  EXPECT_EQ(pointAt<float>(scan.view, 0).x(), 3.0F);
  EXPECT_NEAR(recording.poseAt(0, 0.0).translation().x(), 20.0, 1e-12);
  options.first = 5;
  EXPECT_THROW(makeRecording(options), FileError);
  options.first = 6;
  options.most = kAll;
  EXPECT_THROW(makeRecording(options), FileError);
}

}  // namespace
}  // namespace edgevox
