// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/crease_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

namespace edgevox {
namespace {

constexpr double kProbeRadius = 0.01;  // m, of the circle around a crease that finds its faces
constexpr int kProbes = 720;           // on it

bool isCountable(const sim::Crease& crease) {
  const double bend = std::abs(M_PI - crease.solid_angle);
  return !crease.rim && bend >= kSmallestBend && bend <= kLargestBend;
}

/// The directions from `middle`, across `direction`, in which solid and free space change over.
std::vector<CreaseFace> facesAt(const sim::World& world, const Eigen::Vector3d& middle,
                                const Eigen::Vector3d& direction) {
  const Eigen::Vector3d u = direction.unitOrthogonal();
  const Eigen::Vector3d v = direction.cross(u);
  const auto at = [&](double probe) -> Eigen::Vector3d {
    const double angle = 2.0 * M_PI * probe / kProbes;
    return std::cos(angle) * u + std::sin(angle) * v;
  };
  std::vector<CreaseFace> faces;
  bool before = world.contains(middle + kProbeRadius * at(-1));
  for (int probe = 0; probe < kProbes; ++probe) {
    const bool solid = world.contains(middle + kProbeRadius * at(probe));
    if (solid != before) faces.push_back({at(probe - 0.5), direction.cross(at(probe - 0.5))});
    before = solid;
  }
  return faces;
}

std::vector<uint32_t> enough(const std::vector<std::array<int, 2>>& counts) {
  std::vector<uint32_t> numbers;
  for (size_t i = 0; i < counts.size(); ++i) {
    if (std::min(counts[i][0], counts[i][1]) >= kSightPoints) {
      numbers.push_back(static_cast<uint32_t>(i));
    }
  }
  return numbers;
}

std::vector<Segment> segmentsOf(const std::vector<CreasePiece>& pieces) {
  std::vector<Segment> segments;
  for (const CreasePiece& piece : pieces) segments.push_back(piece.segment);
  return segments;
}

}  // namespace

std::vector<CreasePiece> findPieces(const sim::World& world,
                                    const std::vector<sim::Crease>& creases) {
  std::vector<CreasePiece> pieces;
  for (const sim::Crease& crease : creases) {
    if (!isCountable(crease)) continue;
    const Eigen::Vector3d way = crease.end - crease.start;
    const int count = std::max(1, static_cast<int>(std::ceil(way.norm() / kPieceLength - 1e-9)));
    for (int i = 0; i < count; ++i) {
      const Segment segment{crease.start + way * i / count, crease.start + way * (i + 1) / count};
      const auto faces = facesAt(world, 0.5 * (segment.start + segment.end), way.normalized());
      if (faces.size() == 2) pieces.push_back({segment, {faces[0], faces[1]}});
    }
  }
  return pieces;
}

CreaseSight::CreaseSight(std::vector<CreasePiece> pieces)
    : pieces_(std::move(pieces)),
      index_(segmentsOf(pieces_), kSightReach),
      counts_(pieces_.size(), Counts{}) {}

std::vector<uint32_t> CreaseSight::addScan(const std::vector<Eigen::Vector3d>& points,
                                           const Eigen::Vector3d& sensor) {
  std::vector<bool> in_range;
  for (const CreasePiece& piece : pieces_) {
    const Eigen::Vector3d middle = 0.5 * (piece.segment.start + piece.segment.end);
    in_range.push_back((middle - sensor).norm() <= kSightRange);
  }
  std::vector<Counts> counts(pieces_.size(), Counts{});
  for (const Eigen::Vector3d& point : points) {
    if ((point - sensor).norm() > kSightRange + kSightReach + kPieceLength) continue;
    index_.forEachNear(point, [&](uint32_t i) {
      if (!in_range[i]) return;
      const auto face = faceOf(pieces_[i], point);
      if (face) ++counts[i][*face];
    });
  }
  for (size_t i = 0; i < counts.size(); ++i) {
    for (size_t face = 0; face < 2; ++face) counts_[i][face] += counts[i][face];
  }
  return enough(counts);
}

std::vector<uint32_t> CreaseSight::seen() const { return enough(counts_); }

std::optional<size_t> CreaseSight::faceOf(const CreasePiece& piece,
                                          const Eigen::Vector3d& point) const {
  const Eigen::Vector3d offset = point - piece.segment.start;
  std::optional<size_t> nearest;
  double least = kFaceThickness;
  for (size_t face = 0; face < 2; ++face) {
    const double distance = std::abs(offset.dot(piece.faces[face].normal));
    if (distance > least || offset.dot(piece.faces[face].along) < 0.0) continue;
    least = distance;
    nearest = face;
  }
  return nearest;
}

}  // namespace edgevox
