// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/kitti_folder.hpp"

#include <fstream>
#include <string>
#include <utility>

#include <Eigen/LU>

#include "edgevox/scan/motion.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;

constexpr size_t kPointBytes = 4 * sizeof(float);
constexpr double kPeriod = 0.1;              // of the velodyne [s]
constexpr double kRotationTolerance = 0.01;  // files round to few digits
constexpr const char* kTransform = "Tr:";

/// Of the upper three rows of a matrix, which is not one of a rotation and a translation in a
/// damaged file.
Pose poseOf(const NumberRow& row, const fs::path& file) {
  using Rows = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
  const Eigen::Map<const Rows> rows(row.numbers.data());
  Pose pose = Pose::Identity();
  pose.linear() = rows.leftCols<3>();
  pose.translation() = rows.col(3);
  const Eigen::Matrix3d rotation = pose.linear();
  const Eigen::Matrix3d rest = rotation.transpose() * rotation - Eigen::Matrix3d::Identity();
  if (rest.norm() > kRotationTolerance || rotation.determinant() < 0.0) {
    refuseLine(file, row.line, "its first three columns are no rotation; fetch it again");
  }
  renormalise(pose);
  return pose;
}

/// T_camera_velodyne.
Pose readCalibration(const fs::path& file) {
  std::ifstream in(file);
  if (!in) {
    refuse(file,
           "is missing: its line 'Tr:' has to tell how the velodyne is mounted to the camera");
  }
  std::string text;
  for (size_t line = 1; std::getline(in, text); ++line) {
    if (text.rfind(kTransform, 0) != 0) continue;
    const auto numbers = numbersIn(text.substr(std::string(kTransform).size()));
    if (!numbers || numbers->size() != 12) {
      refuseLine(file, line, "'Tr:' must be followed by the 12 finite numbers of a 3x4 matrix");
    }
    return poseOf({line, *numbers}, file);
  }
  refuse(file, "has no line 'Tr:', which has to tell how the velodyne is mounted to the camera");
}

std::vector<NumberRow> readRowOfEach(const ScanFolder& folder, const fs::path& file, size_t columns,
                                     const std::string& meaning) {
  std::vector<NumberRow> rows = readRows(file, columns, meaning);
  if (rows.size() != folder.scans.size()) {
    refuse(file, "has " + std::to_string(rows.size()) + " lines for " +
                     std::to_string(folder.scans.size()) + " scans in '" + folder.folder.string() +
                     "'; it must hold " + meaning);
  }
  return rows;
}

std::vector<double> readStamps(const ScanFolder& folder) {
  const fs::path file = folder.folder / "times.txt";
  std::vector<double> stamps;
  if (!fs::exists(file)) {
    for (size_t i = 0; i < folder.scans.size(); ++i) {
      stamps.push_back(kPeriod * static_cast<double>(i));
    }
    return stamps;
  }
  for (const NumberRow& row : readRowOfEach(folder, file, 1, "a stamp [s] a scan")) {
    const double stamp = row.numbers.front();
    if (!stamps.empty() && !(stamp > stamps.back())) {
      refuseLine(file, row.line, "the stamp is not later than the one before");
    }
    stamps.push_back(stamp);
  }
  return stamps;
}

size_t sizeOf(const fs::path& file) {
  std::error_code error;
  const uintmax_t size = fs::file_size(file, error);
  if (error) refuse(file, "cannot be read: " + error.message());
  if (size % kPointBytes != 0) {
    refuse(file, "has " + std::to_string(size) +
                     " bytes, not 16 a point (x y z reflectance, float32); fetch it again");
  }
  return size;
}

}  // namespace

std::vector<PosedFile> kittiScans(const ScanFolder& folder) {
  const Pose T_camera_velodyne = readCalibration(folder.folder / "calib.txt");
  const fs::path file = folder.poses.empty() ? folder.folder / "poses.txt" : folder.poses;
  const auto rows =
      readRowOfEach(folder, file, 12, "the 3x4 matrix of the camera's pose, a line a scan");
  const std::vector<double> stamps = readStamps(folder);
  std::vector<PosedFile> scans;
  for (size_t i = 0; i < rows.size(); ++i) {
    sizeOf(folder.scans[i]);  // throws now, not in the middle of a long run
    const Pose T_map_velodyne =
        T_camera_velodyne.inverse() * poseOf(rows[i], file) * T_camera_velodyne;
    scans.push_back({folder.scans[i], stamps[i], standingAt(T_map_velodyne)});
  }
  return scans;
}

RecordedScan readKitti(const fs::path& file) {
  std::vector<uint8_t> bytes(sizeOf(file));
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!in) refuse(file, "cannot be read; check its rights and the disk");
  return scanOf(std::move(bytes), kPointBytes);
}

}  // namespace edgevox
