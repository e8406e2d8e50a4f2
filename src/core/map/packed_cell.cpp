// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/map/packed_cell.hpp"

#include <algorithm>
#include <cmath>

#include "edgevox/map/moment_level.hpp"

namespace edgevox {
namespace {

constexpr double kLargest = 2047.0;                  // in 12 bits, either sign
constexpr double kCovarianceSteps = 4.0 * kLargest;  // [1/voxel^2]
constexpr double kViewSteps = 127.0;
constexpr uint8_t kAxis = 3;  // of the flags: flat_axis + 1
constexpr uint8_t kAnchor = 4;
constexpr uint8_t kBack = 8;
constexpr uint8_t kSelected = 16;
constexpr uint8_t kExplained = 32;

int rounded(double value, double largest) {
  return static_cast<int>(std::lround(std::clamp(value, -largest, largest)));
}

/// The i-th number of 12 bits.
void setNumber(std::array<uint8_t, 9>& bytes, size_t i, int value) {
  const auto bits = static_cast<unsigned>(value) & 0xfffU;
  const size_t at = 3 * i / 2;
  const unsigned shift = i % 2 == 0 ? 0 : 4;
  bytes[at] = static_cast<uint8_t>(bytes[at] | bits << shift);
  bytes[at + 1] = static_cast<uint8_t>(bytes[at + 1] | bits << shift >> 8);
}

int numberIn(const std::array<uint8_t, 9>& bytes, size_t i) {
  const size_t at = 3 * i / 2;
  const unsigned shift = i % 2 == 0 ? 0 : 4;
  const unsigned bits = (bytes[at] | static_cast<unsigned>(bytes[at + 1]) << 8) >> shift & 0xfffU;
  return static_cast<int>(bits ^ 0x800U) - 0x800;
}

}  // namespace

PackedCell::PackedCell(const MomentCell& cell, double size)
    : hits(static_cast<uint8_t>(std::min<uint16_t>(cell.hits, 0xff))),
      flags(static_cast<uint8_t>((cell.flat_axis + 1) | (cell.anchor ? kAnchor : 0) |
                                 (cell.is_back ? kBack : 0) | (cell.selected ? kSelected : 0) |
                                 (cell.explained ? kExplained : 0))) {
  const uint32_t counted = std::min<uint32_t>(cell.count, 0xffff);
  count = {static_cast<uint8_t>(counted), static_cast<uint8_t>(counted >> 8)};
  const double n = cell.count;
  for (size_t i = 0; i < 3; ++i) {
    const double a = cell.sum[i] / n;
    const double b = cell.sum[(i + 1) % 3] / n;
    const double scale = kCovarianceSteps / (size * size);
    setNumber(covariance, i, rounded(scale * (cell.outer[i] / n - a * a), kLargest));
    setNumber(covariance, i + 3, rounded(scale * (cell.outer[i + 3] / n - a * b), kLargest));
    view[i] = static_cast<int8_t>(rounded(kViewSteps * cell.view[i] / n, kViewSteps));
  }
}

MomentCell PackedCell::unpacked(const Eigen::Vector3d& mean, double size) const {
  MomentCell cell;
  cell.count = count[0] | static_cast<uint32_t>(count[1]) << 8;
  const double n = cell.count;
  for (size_t i = 0; i < 3; ++i) {
    const double a = mean[static_cast<Eigen::Index>(i)];
    const double b = mean[static_cast<Eigen::Index>((i + 1) % 3)];
    const double scale = size * size / kCovarianceSteps;
    cell.sum[i] = static_cast<float>(n * a);
    cell.outer[i] = static_cast<float>(n * (scale * numberIn(covariance, i) + a * a));
    cell.outer[i + 3] = static_cast<float>(n * (scale * numberIn(covariance, i + 3) + a * b));
    cell.view[i] = static_cast<float>(n * view[i] / kViewSteps);
  }
  cell.hits = hits;
  cell.flat_axis = static_cast<int8_t>((flags & kAxis) - 1);
  cell.anchor = (flags & kAnchor) != 0;
  cell.is_back = (flags & kBack) != 0;
  cell.selected = (flags & kSelected) != 0;
  cell.explained = (flags & kExplained) != 0;
  return cell;
}

}  // namespace edgevox
