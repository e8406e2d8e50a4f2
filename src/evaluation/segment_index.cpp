// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/segment_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace edgevox {
namespace {

// A sample lies within a quarter of the reach of every point of its segment, so what is within
// reach of the segment is within 1.25 times that of a sample: at most one cell away.
constexpr double kStep = 0.5;   // of the reach
constexpr double kCell = 1.25;  // of the reach

}  // namespace

double Segment::distanceTo(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d way = end - start;
  const double squared = way.squaredNorm();
  const double share = squared > 0.0 ? (point - start).dot(way) / squared : 0.0;
  return (start + std::clamp(share, 0.0, 1.0) * way - point).norm();
}

SegmentIndex::SegmentIndex(std::vector<Segment> segments, double reach)
    : segments_(std::move(segments)), reach_(reach), inverse_cell_(1.0 / (kCell * reach)) {
  for (size_t i = 0; i < segments_.size(); ++i) insert(static_cast<uint32_t>(i));
}

void SegmentIndex::insert(uint32_t number) {
  const Segment& segment = segments_[number];
  const double length = (segment.end - segment.start).norm();
  const int steps = 1 + static_cast<int>(std::ceil(length / (kStep * reach_)));
  for (int step = 0; step <= steps; ++step) {
    const double share = static_cast<double>(step) / steps;
    const Eigen::Vector3d sample = segment.start + share * (segment.end - segment.start);
    const VoxelIndex centre = voxelAt(sample, inverse_cell_);
    for (int n = 0; n < 27; ++n) {
      const VoxelIndex cell{centre.x + n % 3 - 1, centre.y + n / 3 % 3 - 1, centre.z + n / 9 - 1};
      auto& numbers = cells_[packedIndex(cell)];
      if (numbers.empty() || numbers.back() != number) numbers.push_back(number);
    }
  }
}

double SegmentIndex::distanceTo(const Eigen::Vector3d& point) const {
  double nearest = std::numeric_limits<double>::infinity();
  forEachNear(point,
              [&](uint32_t i) { nearest = std::min(nearest, segments_[i].distanceTo(point)); });
  return nearest;
}

}  // namespace edgevox
