// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/block_planes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/map/extreme_eigenvalues.hpp"

namespace edgevox {
namespace {

constexpr double kFewest = 10.0;          // centroids
constexpr double kThickest = 0.03;        // standard deviation across [m] ...
constexpr double kThickestShare = 0.015;  // ... and so much more of a voxel's size
constexpr double kNarrowest = 0.1;        // middle / largest variance
constexpr double kFlattest = 50.0;        // middle / least variance, at least
constexpr double kSensorSigma = 0.02;     // [m]
constexpr float kAsFlat = 2.0F;       // information of a finer plane that a coarser one replaces
constexpr double kExplained = 9.0;    // squared deviation from a plane
constexpr double kLeastFilled = 0.2;  // of kurtosis - skewness^2 - 1
constexpr uint32_t kFewer = 2;        // points or their voxels than planes were fitted to
constexpr double kLeast = 1e-8;       // variance [m^2]

/// Principal axes of points and their variances along them.
struct Axes {
  Eigen::Vector3d normal;  // of the least variance
  Eigen::Vector3d across;  // of the middle one
  double least;
  double middle;
  double greatest;

  explicit Axes(const Moments& moments) {
    const double n = moments.count;
    const Eigen::Matrix3d c = (moments.outer - moments.sum * moments.sum.transpose() / n) / n +
                              kLeast * Eigen::Matrix3d::Identity();
    const ExtremeEigenvalues e(c);
    least = e.least;
    greatest = e.greatest;
    middle = c.trace() - least - greatest;
    normal = axisOf(c, middle, greatest);
    across = normal.cross(axisOf(c, least, middle));
  }

  bool isFlat(double size) const {
    const double thickest = kThickest + kThickestShare * size;
    return least < thickest * thickest && middle > kNarrowest * greatest &&
           middle > kFlattest * least;
  }

 private:
  /// The axis of the third variance.
  static Eigen::Vector3d axisOf(const Eigen::Matrix3d& c, double first, double second) {
    const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d along = (c - first * identity) * (c - second * identity);
    Eigen::Index axis = 0;
    along.diagonal().cwiseAbs().maxCoeff(&axis);
    return along.col(axis).normalized();
  }
};

using Sides = std::vector<const VoxelSide*>;

/// Points of some sides together.
struct Seen {
  Moments moments;
  Eigen::Vector3d view = Eigen::Vector3d::Zero();

  explicit Seen(const Sides& sides) {
    for (const VoxelSide* side : sides) {
      moments += side->moments;
      view += side->view;
    }
  }
  bool isEnough() const { return moments.count >= kFewest; }
};

/// Whether the points lie at two places along an axis. Kurtosis - skewness^2 - 1 is 0 for two
/// values, .8 where all between two values are alike.
bool areAtTwoPlaces(const Sides& sides, const Moments& all, const Eigen::Vector3d& axis) {
  const double centre = axis.dot(all.sum) / all.count;
  double m2 = 0;
  double m3 = 0;
  double m4 = 0;
  for (const VoxelSide* side : sides) {
    const double n = side->moments.count;
    const double mean = axis.dot(side->moments.sum) / n;
    const double within = std::max(0.0, axis.dot(side->moments.outer * axis) / n - mean * mean);
    const double t = mean - centre;
    m2 += n * (t * t + within);
    m3 += n * t * (t * t + 3 * within);
    m4 += n * (t * t * t * t + 6 * t * t * within + 3 * within * within);
  }
  m2 /= all.count;
  m3 /= all.count;
  m4 /= all.count;
  return m4 * m2 - m3 * m3 - m2 * m2 * m2 < kLeastFilled * m2 * m2 * m2;
}

/// Whether the points lie on two parallel lines, which always have a plane: rings of a lidar on a
/// floor and on the wall beside it. They may be farther apart than they are long; where they are
/// about as far apart, their axes are any, and they are not recognised.
bool isPairOfLines(const Sides& sides, const Moments& all, const Axes& axes) {
  return areAtTwoPlaces(sides, all, axes.across) ||
         areAtTwoPlaces(sides, all, axes.normal.cross(axes.across));
}

/// Of enough points; `centre`: of the voxel, from where the moments are counted.
std::optional<Plane> planeOf(const Sides& sides, const Seen& seen, const Axes& axes, double size,
                             const Eigen::Vector3d& centre) {
  const Moments& moments = seen.moments;
  if (!axes.isFlat(size) || isPairOfLines(sides, moments, axes)) return std::nullopt;
  const Eigen::Vector3d normal = axes.normal * (axes.normal.dot(seen.view) < 0 ? -1.0 : 1.0);
  Plane plane;
  plane.normal = normal.cast<float>();
  plane.offset = static_cast<float>(normal.dot(moments.sum / moments.count - centre));
  plane.information = static_cast<float>(1.0 / (axes.least + kSensorSigma * kSensorSigma));
  return plane;
}

/// Where the two sides of a wall were seen, each is a plane of its own.
VoxelPlanes planesOfVoxel(const Sides& sides, double size, const Eigen::Vector3d& centre) {
  VoxelPlanes planes;
  const Seen all(sides);
  planes.points = static_cast<uint32_t>(all.moments.count);
  planes.voxels = static_cast<uint32_t>(sides.size());
  if (!all.isEnough()) return planes;
  const Axes axes(all.moments);
  std::array<Sides, 2> halves;
  for (const VoxelSide* side : sides) {
    halves[axes.normal.dot(side->view) < 0 ? 1 : 0].push_back(side);
  }
  const auto add = [&](const std::optional<Plane>& plane) {
    if (plane) planes.add(*plane);
  };
  if (halves[0].empty() || halves[1].empty()) {
    add(planeOf(sides, all, axes, size, centre));
    return planes;
  }
  for (const Sides& half : halves) {
    const Seen seen(half);
    if (seen.isEnough()) add(planeOf(half, seen, Axes(seen.moments), size, centre));
  }
  return planes;
}

/// Whether planes tell more than those of the points that are left or came since: what scans see
/// when they come back may be a corner of what they saw before.
bool stay(const VoxelPlanes& known, const VoxelPlanes& now) {
  if (!known.forgotten && now.points >= known.points) return false;
  return kFewer * now.points < known.points || kFewer * now.voxels < known.voxels;
}

bool isSameSide(const Plane& a, const Plane& b) { return a.normal.dot(b.normal) > 0.5F; }

}  // namespace

BlockPlanes::BlockPlanes(const VoxelIndex& block, const std::vector<VoxelSide>& sides, double size,
                         const MatchMap& before)
    : block_(block), size_(size) {
  for (int level = kCoarsest; level >= kFinest; --level) {
    const auto across = static_cast<size_t>(sideOf(level));
    planesOf(level).resize(across * across * across);
    needed_[index(level)].resize(planesOf(level).size());
    fit(level, sides, before.planes(level));
  }
  for (int level = kFinest; level < kCoarsest; ++level) dropCovered(level);
}

VoxelIndex BlockPlanes::voxelAt(int level, size_t i) const {
  const int across = sideOf(level);
  const auto at = static_cast<int>(i);
  return {block_.x * across + at % across, block_.y * across + at / across % across,
          block_.z * across + at / (across * across)};
}

size_t BlockPlanes::positionOf(int level, const VoxelIndex& v) const {
  const int across = sideOf(level);
  return static_cast<size_t>(v.x - block_.x * across +
                             across *
                                 (v.y - block_.y * across + across * (v.z - block_.z * across)));
}

Eigen::Vector3d BlockPlanes::centreOf(int level, size_t i) const {
  const VoxelIndex v = voxelAt(level, i);
  const int across = sideOf(level);
  const VoxelIndex in_block{v.x - block_.x * across, v.y - block_.y * across,
                            v.z - block_.z * across};
  const double size = size_ * (1 << (level - 1));
  return voxelCentre(in_block, size) - Eigen::Vector3d::Constant(0.5 * size * across);
}

void BlockPlanes::fit(int level, const std::vector<VoxelSide>& sides, const PlaneLevel& before) {
  std::vector<VoxelPlanes>& planes = planesOf(level);
  std::vector<Sides> in_voxels(planes.size());
  for (const VoxelSide& side : sides) {
    in_voxels[positionOf(level, coarser(side.voxel, level - 1))].push_back(&side);
  }
  const double size = size_ * (1 << (level - 1));
  for (size_t i = 0; i < planes.size(); ++i) {
    planes[i] = planesOfVoxel(in_voxels[i], size, centreOf(level, i));
    const VoxelPlanes* known = before.find(voxelAt(level, i));
    if (known == nullptr || !stay(*known, planes[i])) continue;
    planes[i] = *known;
    planes[i].forgotten = true;
  }
}

/// Drops planes where a coarser voxel has one that is nearly as flat as all that it stands for.
void BlockPlanes::dropCovered(int level) {
  for (size_t i = 0; i < planesOf(level).size(); ++i) {
    VoxelPlanes& planes = planesOf(level)[i];
    VoxelPlanes left = planes;
    left.sides = {};
    left.count = 0;
    for (uint32_t side = 0; side < planes.count; ++side) {
      const Plane& plane = planes.sides[side];
      const float needed = std::max(plane.information, needed_[index(level)][i][side]);
      if (!isCovered(level, i, plane, needed)) left.add(plane);
    }
    planes = left;
  }
}

bool BlockPlanes::isCovered(int level, size_t i, const Plane& plane, float needed) {
  const VoxelIndex v = voxelAt(level, i);
  for (int above = level + 1; above <= kCoarsest; ++above) {
    const size_t at = positionOf(above, coarser(v, above - level));
    VoxelPlanes& coarse = planesOf(above)[at];
    for (uint32_t side = 0; side < coarse.count; ++side) {
      const Plane& of = coarse.sides[side];
      if (!isSameSide(plane, of) || kAsFlat * of.information < needed) continue;
      float& its = needed_[index(above)][at][side];
      its = std::max(its, needed);
      return true;
    }
  }
  return false;
}

bool BlockPlanes::explains(const VoxelSide& side) const {
  const Eigen::Vector3d mean = side.moments.sum / side.moments.count;
  for (int level = kFinest; level <= kCoarsest; ++level) {
    const size_t i = positionOf(level, coarser(side.voxel, level - 1));
    const Eigen::Vector3d from_centre = mean - centreOf(level, i);
    for (const Plane& plane : planesOf(level)[i]) {
      const Eigen::Vector3d normal = plane.normal.cast<double>();
      if (normal.dot(side.view) < 0) continue;
      const double off = normal.dot(from_centre) - static_cast<double>(plane.offset);
      if (off * off * static_cast<double>(plane.information) < kExplained) return true;
    }
  }
  return false;
}

}  // namespace edgevox
