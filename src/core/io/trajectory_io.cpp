// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/io/trajectory_io.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

#include "edgevox/io/atomic_file.hpp"
#include "edgevox/io/number_text.hpp"

namespace edgevox {
namespace {

constexpr size_t kNumbers = 8;
constexpr double kUnitTolerance = 0.01;  // of a quaternion's norm: files round to few digits

using Line = std::array<double, kNumbers>;

std::vector<std::string> wordsOf(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

double numberOf(const std::string& word) {
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (end == word.c_str() || *end != '\0' || !std::isfinite(value)) {
    throw TrajectoryError("'" + word + "' is no finite number");
  }
  return value;
}

Line numbersOf(const std::vector<std::string>& words) {
  if (words.size() != kNumbers) {
    throw TrajectoryError("there are " + std::to_string(words.size()) +
                          " values; a line is 'stamp tx ty tz qx qy qz qw'");
  }
  Line line;
  for (size_t i = 0; i < kNumbers; ++i) line[i] = numberOf(words[i]);
  return line;
}

StampedPose poseOf(const Line& n) {
  const Eigen::Quaterniond q(n[7], n[4], n[5], n[6]);
  if (std::abs(q.norm() - 1.0) > kUnitTolerance) {
    throw TrajectoryError("the quaternion has norm " + std::to_string(q.norm()) +
                          " instead of 1; its order is qx qy qz qw");
  }
  StampedPose stamped;
  stamped.stamp = n[0];
  stamped.pose.linear() = q.normalized().toRotationMatrix();
  stamped.pose.translation() = Eigen::Vector3d(n[1], n[2], n[3]);
  return stamped;
}

void append(Trajectory& trajectory, const StampedPose& next) {
  if (!trajectory.empty() && !(next.stamp > trajectory.back().stamp)) {
    throw TrajectoryError("the stamp is not later than the one before; sort the lines by stamp");
  }
  trajectory.push_back(next);
}

}  // namespace

Trajectory parseTum(std::istream& in, const std::string& name) {
  Trajectory trajectory;
  std::string text;
  for (size_t number = 1; std::getline(in, text); ++number) {
    const std::vector<std::string> words = wordsOf(text);
    if (words.empty() || words.front().front() == '#') continue;
    try {
      append(trajectory, poseOf(numbersOf(words)));
    } catch (const TrajectoryError& error) {
      throw TrajectoryError(name + ", line " + std::to_string(number) + ": " + error.what());
    }
  }
  if (in.bad()) throw TrajectoryError(name + ": reading stopped half-way; check the disk");
  return trajectory;
}

Trajectory readTum(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file)) {
    throw FileError("cannot read the trajectory '" + file.string() +
                    "'; give the name of a file in TUM format");
  }
  return parseTum(in, file.string());
}

std::string tumText(const Trajectory& trajectory) {
  std::string text;
  for (const StampedPose& stamped : trajectory) {
    const Eigen::Vector3d t = stamped.pose.translation();
    Eigen::Quaterniond q = Eigen::Quaterniond(stamped.pose.linear()).normalized();
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    text += fixedText(stamped.stamp, 6);
    for (const double value : {t.x(), t.y(), t.z()}) text += " " + fixedText(value, 9);
    for (const double value : {q.x(), q.y(), q.z(), q.w()}) text += " " + fixedText(value, 12);
    text += "\n";
  }
  return text;
}

void writeTum(const std::filesystem::path& file, const Trajectory& trajectory) {
  writeFile(file, tumText(trajectory));
}

}  // namespace edgevox
