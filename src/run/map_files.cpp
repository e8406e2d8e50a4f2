// SPDX-License-Identifier: BSD-3-Clause
#include "run/map_files.hpp"

#include <pcl/io/pcd_io.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <exception>
#include <string>

#include "edgevox/io/atomic_file.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;

using PclCloud = pcl::PointCloud<pcl::PointXYZ>;

// PCL refuses to write clouds without points.
constexpr const char* kEmptyPcd =
    "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\n"
    "TYPE F F F\nCOUNT 1 1 1\nWIDTH 0\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 0\n"
    "DATA binary\n";

PclCloud toPcl(const std::vector<Eigen::Vector3f>& points) {
  PclCloud cloud;
  cloud.reserve(points.size());
  for (const Eigen::Vector3f& p : points) cloud.push_back(pcl::PointXYZ(p.x(), p.y(), p.z()));
  return cloud;
}

/// PCL's reasons begin with a colon.
[[noreturn]] void fail(const fs::path& target, const std::string& reason) {
  throw FileError("cannot write '" + target.string() +
                  "': " + reason.substr(std::min(reason.size(), reason.find_first_not_of(": "))) +
                  "; check that its folder may be written to and has space left");
}

}  // namespace

void writePly(const fs::path& file, const std::vector<Eigen::Vector3f>& points) {
  static_assert(sizeof(Eigen::Vector3f) == 12, "points are packed");
  std::string content = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                        std::to_string(points.size()) +
                        "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  content.append(reinterpret_cast<const char*>(points.data()), points.size() * 12);
  writeFile(file, content);
}

void writePcd(const fs::path& target, const std::vector<Eigen::Vector3f>& points) {
  if (points.empty()) return writeFile(target, kEmptyPcd);
  AtomicFile file(target);
  int result = 0;
  try {  // PCL reports some failures by its result, others by an exception
    result = pcl::io::savePCDFileBinary(file.temporary().string(), toPcl(points));
  } catch (const std::exception& error) {
    fail(target, error.what());
  }
  if (result != 0) fail(target, "PCL failed");
  file.keep();
}

}  // namespace edgevox
