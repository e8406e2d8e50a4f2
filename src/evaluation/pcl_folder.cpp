// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/pcl_folder.hpp"

#include <pcl/PCLPointCloud2.h>
#include <pcl/console/print.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <algorithm>
#include <array>
#include <exception>
#include <stdexcept>
#include <string>
#include <utility>

#include "edgevox/io/trajectory_io.hpp"
#include "evaluation/scan_stream.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;
using Field = pcl::PCLPointField;

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

/// The only trajectory among the files of a folder.
Trajectory trajectoryIn(const fs::path& folder) {
  std::vector<Trajectory> found;
  std::string faults;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string type = entry.path().extension();
    if (!entry.is_regular_file() || (type != ".tum" && type != ".txt")) continue;
    try {
      Trajectory trajectory = readTum(entry.path());
      if (!trajectory.empty()) found.push_back(std::move(trajectory));
    } catch (const TrajectoryError& error) {
      faults += std::string("; ") + error.what();
    }
  }
  if (found.size() == 1) return std::move(found.front());
  throw std::invalid_argument("'" + folder.string() + "' holds " + std::to_string(found.size()) +
                              " trajectories in TUM format, *.tum or *.txt; name the one of its "
                              "scans" +
                              faults);
}

double stampOf(const fs::path& file, size_t poses, size_t scans) {
  const std::string stem = file.stem();
  const auto numbers = numbersIn(stem);
  if (numbers && numbers->size() == 1) return numbers->front();
  throw std::invalid_argument("'" + file.string() + "': its name is no stamp [s], and there are " +
                              std::to_string(poses) + " poses for " + std::to_string(scans) +
                              " scans; give a pose for each of them");
}

std::vector<PosedFile> byRow(const std::vector<fs::path>& files, const Trajectory& trajectory) {
  std::vector<PosedFile> scans;
  for (size_t i = 0; i < files.size(); ++i) {
    const double stamp = trajectory[i].stamp;
    scans.push_back({files[i], stamp, poseAround(stamp, trajectory)});
  }
  return scans;
}

std::vector<PosedFile> byStamp(const std::vector<fs::path>& files, const Trajectory& trajectory) {
  std::vector<PosedFile> scans;
  for (const fs::path& file : files) {
    const double stamp = stampOf(file, trajectory.size(), files.size());
    scans.push_back({file, stamp, poseAround(stamp, trajectory)});
  }
  const auto earlier = [](const PosedFile& a, const PosedFile& b) { return a.stamp < b.stamp; };
  std::stable_sort(scans.begin(), scans.end(), earlier);
  const auto hasPose = [](const PosedFile& scan) { return bool(scan.truth); };
  if (std::any_of(scans.begin(), scans.end(), hasPose)) return scans;
  throw std::invalid_argument("'" + files.front().string() +
                              "': no pose is within 5 ms of the stamp that is its name, nor of any "
                              "other scan's; check that the poses are those of these scans");
}

const Field& fieldOf(const pcl::PCLPointCloud2& cloud, const char* name, const fs::path& file) {
  const auto is_it = [&](const Field& field) { return field.name == name; };
  const auto field = std::find_if(cloud.fields.begin(), cloud.fields.end(), is_it);
  if (field != cloud.fields.end()) return *field;
  refuse(file, std::string("has no field '") + name + "'; a scan has x, y and z");
}

void checkLayout(const pcl::PCLPointCloud2& cloud, const fs::path& file) {
  const int type = fieldOf(cloud, "x", file).datatype;
  const size_t size = type == Field::FLOAT64 ? sizeof(double) : sizeof(float);
  for (const char* axis : kAxes) {
    const Field& field = fieldOf(cloud, axis, file);
    if (field.datatype != type || (type != Field::FLOAT32 && type != Field::FLOAT64)) {
      refuse(file, "must have x, y and z that are all float32 or all float64");
    }
    if (field.offset + size > cloud.point_step) refuse(file, "is damaged; fetch it again");
  }
  const size_t points = size_t{cloud.width} * cloud.height;
  if (points != cloud.data.size() / cloud.point_step) refuse(file, "is damaged; fetch it again");
}

RecordedScan checkedScan(pcl::PCLPointCloud2 cloud, const fs::path& file) {
  checkLayout(cloud, file);
  RecordedScan scan = scanOf(std::move(cloud.data), cloud.point_step);
  for (size_t i = 0; i < kAxes.size(); ++i) {
    scan.view.xyz_offset[i] = fieldOf(cloud, kAxes[i], file).offset;
  }
  const bool wide = fieldOf(cloud, "x", file).datatype == Field::FLOAT64;
  scan.view.xyz_type = wide ? Scalar::kFloat64 : Scalar::kFloat32;
  return scan;
}

int loadPcd(const std::string& file, pcl::PCLPointCloud2& cloud) {
  pcl::PCDReader reader;
  const bool has_fields = reader.readHeader(file, cloud) >= 0 && !cloud.fields.empty();
  return has_fields ? reader.read(file, cloud) : -1;  // without fields read() would crash
}

int loadPly(const std::string& file, pcl::PCLPointCloud2& cloud) {
  return pcl::PLYReader().read(file, cloud);
}

RecordedScan readBy(int (*load)(const std::string&, pcl::PCLPointCloud2&), const fs::path& file) {
  pcl::PCLPointCloud2 cloud;
  try {
    if (load(file.string(), cloud) < 0) throw std::runtime_error("PCL cannot read it");
  } catch (const std::exception& error) {  // of many types, also for lengths that are damaged
    refuse(file, std::string("is missing or damaged: ") + error.what() + "; fetch it again");
  }
  return checkedScan(std::move(cloud), file);
}

}  // namespace

std::vector<PosedFile> pclScans(const ScanFolder& folder) {
  // PCL would warn of each property of a PLY that it leaves out.
  pcl::console::setVerbosityLevel(pcl::console::L_ERROR);
  const Trajectory trajectory =
      folder.poses.empty() ? trajectoryIn(folder.folder) : readTum(folder.poses);
  const bool pose_each = trajectory.size() == folder.scans.size();
  return pose_each ? byRow(folder.scans, trajectory) : byStamp(folder.scans, trajectory);
}

RecordedScan readPcd(const fs::path& file) { return readBy(loadPcd, file); }

RecordedScan readPly(const fs::path& file) { return readBy(loadPly, file); }

}  // namespace edgevox
