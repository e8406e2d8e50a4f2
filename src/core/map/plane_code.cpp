// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/plane_code.hpp"

#include <algorithm>
#include <cmath>

#include "core/map/quantised.hpp"
#include "edgevox/archive.hpp"

namespace edgevox {
namespace {

constexpr double kNormalSteps = 2046.0;  // even, so that axes are exact
constexpr double kOffsetSteps = 2048.0;  // a voxel
constexpr double kLeastOffset = -16.0;   // [voxel]

}  // namespace

void Numbers16::add(double value) {
  const auto number = static_cast<unsigned>(std::min(std::max(std::round(value), 0.0), 65535.0));
  high.bytes.push_back(static_cast<char>(number >> 8));
  low.bytes.push_back(static_cast<char>(number & 255U));
}

double Numbers16::number(size_t i) const {
  if (i >= high.bytes.size() || i >= low.bytes.size()) throw ArchiveError("planes are missing");
  return 256.0 * valueOf(high.bytes[i]) + valueOf(low.bytes[i]);
}

void PlaneCode::add(const Plane& plane, double size) {
  const Eigen::Vector2d p = unfolded(plane.normal.cast<double>());
  normal[0].add((p.x() + 1) / 2 * kNormalSteps);
  normal[1].add((p.y() + 1) / 2 * kNormalSteps);
  offset.add((static_cast<double>(plane.offset) / size - kLeastOffset) * kOffsetSteps);
  information.bytes.push_back(informationCode(static_cast<double>(plane.information)));
}

Plane PlaneCode::plane(size_t i, double size) const {
  if (i >= information.bytes.size()) throw ArchiveError("planes are missing");
  Plane plane;
  plane.normal = folded({2 * normal[0].number(i) / kNormalSteps - 1,
                         2 * normal[1].number(i) / kNormalSteps - 1})
                     .cast<float>();
  plane.offset = static_cast<float>((offset.number(i) / kOffsetSteps + kLeastOffset) * size);
  plane.information = static_cast<float>(informationOf(information.bytes[i]));
  return plane;
}

}  // namespace edgevox
