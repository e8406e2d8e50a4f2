// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/uos_folder.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Geometry>

namespace edgevox {
namespace {

namespace fs = std::filesystem;

constexpr double kMetresPerCentimetre = 0.01;
constexpr size_t kMostHeaderLines = 10;  // as 3DTK takes
constexpr size_t kCountedPoints = 1000;  // tell the length of a line
constexpr size_t kPointBytes = 3 * sizeof(float);

/// From the axes of 3DTK: right, up, forward.
Eigen::Matrix3d axesFromUos() {
  return (Eigen::Matrix3d() << 0, 0, 1, -1, 0, 0, 0, 1, 0).finished();
}

/// 3DTK's EulerToMatrix4: about z first, x last.
Eigen::Matrix3d rotationFromUos(const std::vector<double>& degrees) {
  const auto turned = [&](size_t axis) {
    const Eigen::Vector3d about = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(axis));
    return Eigen::AngleAxisd(degrees[axis] * M_PI / 180.0, about).toRotationMatrix();
  };
  return turned(0) * turned(1) * turned(2);
}

Pose readPose(const fs::path& file) {
  const auto rows = readRows(file, 3, "a line of x y z [cm] and one of three angles [degrees]");
  if (rows.size() != 2) {
    refuse(file, "has " + std::to_string(rows.size()) +
                     " lines; it must hold one of x y z [cm] and one of three angles [degrees]");
  }
  const std::vector<double>& position = rows[0].numbers;
  const Eigen::Matrix3d axes = axesFromUos();
  Pose pose = Pose::Identity();
  pose.linear() = axes * rotationFromUos(rows[1].numbers) * axes.transpose();
  pose.translation() = axes * Eigen::Map<const Eigen::Vector3d>(position.data());
  pose.translation() *= kMetresPerCentimetre;
  return pose;
}

enum class UosLine { kPoint, kNone, kShort, kWords };

/// Reads the point of a line, if it has one.
UosLine readLine(const std::string& text, Eigen::Vector3d& point) {
  const char* end = text.data() + text.size();
  const char* at = skipSpaces(text.data(), end);
  if (at == end || *at == '#') return UosLine::kNone;
  for (int axis = 0; axis < 3; ++axis) {
    if (skipSpaces(at, end) == end) return UosLine::kShort;
    at = readNumber(at, end, point[axis]);
    if (at == nullptr) return UosLine::kWords;
  }
  return UosLine::kPoint;
}

void append(const Eigen::Vector3d& point, std::vector<uint8_t>& bytes) {
  const Eigen::Vector3d metres = kMetresPerCentimetre * point;
  const std::array<float, 3> packed{static_cast<float>(metres.z()), static_cast<float>(-metres.x()),
                                    static_cast<float>(metres.y())};
  std::array<uint8_t, kPointBytes> raw{};
  std::memcpy(raw.data(), packed.data(), kPointBytes);
  bytes.insert(bytes.end(), raw.begin(), raw.end());
}

/// Makes room for a file of lines like those read so far: a scan has millions of points.
void reserve(const fs::path& file, size_t read, std::vector<uint8_t>& bytes) {
  const double share = static_cast<double>(fs::file_size(file)) / static_cast<double>(read);
  bytes.reserve(static_cast<size_t>(1.05 * share * static_cast<double>(bytes.size())));
}

}  // namespace

std::vector<PosedFile> uosScans(const ScanFolder& folder) {
  if (!folder.poses.empty()) {
    throw std::invalid_argument("the poses of '" + folder.folder.string() +
                                "' are in its .pose files: leave out '" + folder.poses.string() +
                                "'");
  }
  std::vector<PosedFile> scans;
  for (const fs::path& file : folder.scans) {
    const double number = std::stod(file.stem().string().substr(std::strlen("scan")));
    if (!scans.empty() && number == scans.back().stamp) {
      refuse(file, "has the number of '" + scans.back().file.string() + "'; leave one of them");
    }
    scans.push_back(
        {file, number, standingAt(readPose(fs::path(file).replace_extension(".pose")))});
  }
  return scans;
}

RecordedScan readUos(const fs::path& file) {
  std::ifstream in(file);
  if (!in) refuse(file, "cannot be read; check that it is still there and its rights");
  std::vector<uint8_t> bytes;
  std::string text;
  Eigen::Vector3d point;
  size_t read = 0;
  for (size_t line = 1; std::getline(in, text); ++line) {
    read += text.size() + 1;
    const UosLine kind = readLine(text, point);
    const bool header = kind == UosLine::kWords && bytes.empty() && line <= kMostHeaderLines;
    if (kind == UosLine::kNone || header) continue;
    if (kind != UosLine::kPoint) {
      refuseLine(file, line, "this does not begin with three numbers, x y z [cm]; fetch it again");
    }
    append(point, bytes);
    if (bytes.size() == kCountedPoints * kPointBytes) reserve(file, read, bytes);
  }
  if (in.bad()) refuse(file, "cannot be read to its end; check the disk");
  return scanOf(std::move(bytes), kPointBytes);
}

}  // namespace edgevox
