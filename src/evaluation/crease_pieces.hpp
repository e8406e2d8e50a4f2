// SPDX-License-Identifier: BSD-3-Clause
// Which stretches of the true edges of a world a sensor has seen well enough to find them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "evaluation/segment_index.hpp"
#include "sim/truth.hpp"

namespace edgevox {

constexpr double kPieceLength = 0.25;     ///< m, at most
constexpr double kSmallestBend = 1.2217;  ///< rad, 70 degrees
constexpr double kLargestBend = 1.9199;   ///< rad, 110 degrees
constexpr double kSightRange = 10.0;      ///< m, from the sensor to the middle of the piece
constexpr double kSightReach = 0.3;       ///< m, from the piece to a point that tells of it
constexpr double kFaceThickness = 0.03;   ///< m, from a face to a point on it
constexpr int kSightPoints = 20;          ///< on each face

/// A face that ends at a crease.
struct CreaseFace {
  Eigen::Vector3d along;   ///< unit, from the crease into the face
  Eigen::Vector3d normal;  ///< unit, of either sign
};

/// A short stretch of a straight crease.
struct CreasePiece {
  Segment segment;
  std::array<CreaseFace, 2> faces;
};

/// The straight creases that bend by 70 to 110 degrees, cut up. Left out are stretches around which
/// the surface is more than two faces.
std::vector<CreasePiece> findPieces(const sim::World& world,
                                    const std::vector<sim::Crease>& creases);

/// A piece is seen if it is within kSightRange and on each of its faces lie kSightPoints points
/// within kSightReach of it.
class CreaseSight {
 public:
  explicit CreaseSight(std::vector<CreasePiece> pieces);

  /// Adds a scan's points, world frame [m]; the pieces that this scan alone has seen, ascending.
  std::vector<uint32_t> addScan(const std::vector<Eigen::Vector3d>& points,
                                const Eigen::Vector3d& sensor);
  /// The pieces seen by all scans together, ascending.
  std::vector<uint32_t> seen() const;

  std::vector<Segment> segments() const { return index_.segments(); }

 private:
  using Counts = std::array<int, 2>;

  std::optional<size_t> faceOf(const CreasePiece& piece, const Eigen::Vector3d& point) const;

  std::vector<CreasePiece> pieces_;
  SegmentIndex index_;
  std::vector<Counts> counts_;  // of all scans
};

}  // namespace edgevox
