// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/map/moment_level.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

namespace edgevox {
namespace {

constexpr double kSensorSigma = 0.02;  // [m]
constexpr double kVoxelSigma = 0.3;    // [voxel]; spread assumed where few points tell
constexpr double kPriorWeight = 2.0;   // [centroids]
constexpr double kAlong = 0.1;         // of the information along a surface that is used, at most
constexpr double kFlat = 0.1;          // of the variance at most across a flat voxel
constexpr double kPatch = 0.3;         // middle / largest variance of a full patch of surface
constexpr double kLeastPatch = 0.1;    // share of a patch that an anchor needs
constexpr double kBehind = 0.02;       // cosine to the normal of a surface seen from behind
constexpr double kOpposite = 0.3;      // cosine between views of two sides of anything else

/// Smallest and largest root of the characteristic polynomial of a positive definite matrix, by
/// Newton steps from outside: monotone, and the same on every machine.
struct ExtremeEigenvalues {
  double least;
  double greatest;

  explicit ExtremeEigenvalues(const Eigen::Matrix3d& m) {
    const double c2 = m.trace();
    const double c1 = m(0, 0) * m(1, 1) + m(1, 1) * m(2, 2) + m(2, 2) * m(0, 0) -
                      m(0, 1) * m(0, 1) - m(1, 2) * m(1, 2) - m(2, 0) * m(2, 0);
    const double c0 = m.determinant();
    least = rootFrom(0.0, c2, c1, c0);
    greatest = rootFrom(c2, c2, c1, c0);
  }

 private:
  static double rootFrom(double l, double c2, double c1, double c0) {
    for (int i = 0; i < 40; ++i) {
      const double value = ((l - c2) * l + c1) * l - c0;
      const double slope = (3 * l - 2 * c2) * l + c1;
      if (!(slope > 0)) break;
      const double step = value / slope;
      l -= step;
      if (!(std::abs(step) > 1e-9 * l)) break;
    }
    return l;
  }
};

Eigen::Matrix3d symmetric(const std::array<float, 6>& m) {
  Eigen::Matrix3d out;
  out << m[0], m[3], m[5], m[3], m[1], m[4], m[5], m[4], m[2];
  return out;
}

Eigen::Matrix3d covarianceOf(const MomentLevel::Cell& cell, double size) {
  const double n = cell.count;
  const Eigen::Vector3d sum(cell.sum[0], cell.sum[1], cell.sum[2]);
  const Eigen::Matrix3d scatter = symmetric(cell.outer) - sum * sum.transpose() / n;
  const double prior = kPriorWeight * kVoxelSigma * kVoxelSigma * size * size;
  return (scatter + prior * Eigen::Matrix3d::Identity()) / (n + kPriorWeight) +
         kSensorSigma * kSensorSigma * Eigen::Matrix3d::Identity();
}

/// The shape of what a covariance shows.
struct Shape {
  double greatest;         // eigenvalue
  Eigen::Matrix3d across;  // the information across the surface; zero if there is no surface
  Eigen::Index axis = 0;   // nearest to the normal
  Eigen::Vector3d normal;
  double thickness;  // variance along the normal, of all
  double patch;      // 1 for a patch of surface, 0 for a line, as one ring of a lidar draws it: the
                     // normal of a line is any
  bool flat;

  explicit Shape(const Eigen::Matrix3d& covariance) {
    const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
    const ExtremeEigenvalues e(covariance);
    const double middle = covariance.trace() - e.least - e.greatest;
    const double spread = e.greatest - e.least;
    greatest = e.greatest;
    across.setZero();
    if (spread > 1e-4 * e.greatest) {
      across = (covariance - middle * identity) * (covariance - e.greatest * identity) /
               (e.least * middle * spread);
    }
    across.diagonal().maxCoeff(&axis);
    normal = across.col(axis).normalized();
    thickness = e.least / covariance.trace();
    flat = across.trace() > 0 && thickness < kFlat;
    const double width = middle / e.greatest / kPatch;
    patch = std::min(1.0, width * width);
  }
};

/// Across the surface all of the information, along it only a share: the extent of what was seen
/// of a voxel would else fake a position, most of all in a corridor, where many flat voxels that
/// tell nothing outvote the few that do.
Eigen::Matrix3d informationOf(const Eigen::Matrix3d& covariance, const Shape& shape) {
  const double share = std::min(kAlong, shape.thickness * shape.thickness / kFlat);
  const Eigen::Matrix3d all = covariance.inverse() - Eigen::Matrix3d::Identity() / shape.greatest;
  return share * all + (1 - share) * shape.patch * shape.across;
}

/// See Surface::side: the normal turned to the viewer where the voxel is flat, the mean
/// viewing direction elsewhere.
Eigen::Vector3f sideOf(const Shape& shape, const Eigen::Vector3d& view) {
  if (!shape.flat) return (view.normalized() / kOpposite).cast<float>();
  return (shape.normal * (shape.normal.dot(view) < 0 ? -1.0 : 1.0) / kBehind).cast<float>();
}

Surface surfaceOf(const MomentLevel::Cell& cell, const VoxelIndex& v, double size) {
  const Eigen::Vector3d sum(cell.sum[0], cell.sum[1], cell.sum[2]);
  const Eigen::Matrix3d covariance = covarianceOf(cell, size);
  const Shape shape(covariance);
  const Eigen::Matrix3f w = informationOf(covariance, shape).cast<float>();
  Surface surface;
  surface.mean = (voxelCentre(v, size) + sum / cell.count).cast<float>();
  surface.information = {w(0, 0), w(1, 1), w(2, 2), w(0, 1), w(1, 2), w(2, 0)};
  surface.side = sideOf(shape, Eigen::Vector3d(cell.view[0], cell.view[1], cell.view[2]));
  return surface;
}

}  // namespace

Moments Moments::at(const Eigen::Vector3d& point, double count) {
  return {count, count * point, count * point * point.transpose()};
}

Moments& Moments::operator+=(const Moments& more) {
  count += more.count;
  sum += more.sum;
  outer += more.outer;
  return *this;
}

Moments Moments::about(const Eigen::Vector3d& origin) const {
  const Eigen::Matrix3d cross = sum * origin.transpose();
  return {count, sum - count * origin,
          outer - cross - cross.transpose() + count * origin * origin.transpose()};
}

uint32_t MomentLevel::slotFor(const VoxelIndex& v, SurfaceLevel& surfaces) {
  const uint32_t slot = surfaces.insert(v);
  if (slot >= size() || cells_[slot].count == 0) makeCell(slot, v);
  return slot;
}

void MomentLevel::makeCell(uint32_t slot, const VoxelIndex& v) {
  while (size() <= slot) {
    cells_.grow();
    voxels_.grow();
  }
  voxels_[slot] = v;
}

/// The cell of the surface in the voxel that `to_sensor` sees.
uint32_t MomentLevel::sideSlot(uint32_t slot, const Eigen::Vector3f& to_sensor,
                               SurfaceLevel& surfaces) {
  if (!surfaces.surface(slot).facesAway(to_sensor)) return slot;
  if (!surfaces.hasBack(slot)) {
    const uint32_t back = surfaces.insertBack(slot);
    makeCell(back, voxels_[slot]);
    cells_[back].is_back = true;
    cells_[back].selected = cells_[slot].selected;
  }
  return surfaces.surface(slot).back_surface;
}

bool MomentLevel::add(uint32_t slot, const Eigen::Vector3d& centroid,
                      const Eigen::Vector3f& to_sensor, uint32_t scan, SurfaceLevel& surfaces) {
  const uint32_t side = sideSlot(slot, to_sensor, surfaces);
  Cell& seen = cells_[side];
  const Eigen::Vector3f d = (centroid - voxelCentre(voxels_[slot], voxel_size_)).cast<float>();
  for (size_t i = 0; i < 3; ++i) {
    const auto a = static_cast<Eigen::Index>(i);
    const auto b = static_cast<Eigen::Index>((i + 1) % 3);
    seen.sum[i] += d[a];
    seen.outer[i] += d[a] * d[a];
    seen.outer[i + 3] += d[a] * d[b];
    seen.view[i] += to_sensor[a];
  }
  ++seen.count;
  setStale(side);
  Cell& cell = cells_[slot];
  if (cell.last_scan == scan) return false;
  cell.last_scan = scan;
  if (cell.hits < std::numeric_limits<uint16_t>::max()) ++cell.hits;
  return true;
}

void MomentLevel::setStale(uint32_t slot) {
  if (cells_[slot].stale) return;
  cells_[slot].stale = true;
  stale_.push_back(slot);
}

void MomentLevel::setMoments(uint32_t slot, const Moments& moments) {
  Cell& cell = cells_[slot];
  const auto kept = static_cast<float>(moments.count / cell.count);
  for (size_t i = 0; i < 3; ++i) {
    const auto a = static_cast<Eigen::Index>(i);
    cell.sum[i] = static_cast<float>(moments.sum[a]);
    cell.outer[i] = static_cast<float>(moments.outer(a, a));
    cell.outer[i + 3] = static_cast<float>(moments.outer(a, (a + 1) % 3));
    cell.view[i] *= kept;
  }
  cell.count = static_cast<uint32_t>(moments.count);
  setStale(slot);
}

void MomentLevel::erase(const VoxelIndex& v, SurfaceLevel& surfaces) {
  const uint32_t slot = surfaces.slotOf(v);
  if (surfaces.hasBack(slot)) cells_[surfaces.surface(slot).back_surface] = {};
  cells_[slot] = {};
  surfaces.erase(v);
}

void MomentLevel::update(uint32_t slot, Side side, SurfaceLevel& surfaces) {
  Surface& now = surfaces.surface(slot);
  const Surface before = now;
  now = surfaceOf(cells_[slot], voxels_[slot], voxel_size_);
  now.back_surface = before.back_surface;
  if (side == Side::kKeep) now.side = before.side;
  cells_[slot].stale = false;
}

void MomentLevel::updateSelected(SurfaceLevel& surfaces) {
  for (const uint32_t slot : stale_) {
    if (!cells_[slot].stale) continue;
    if (cells_[slot].selected) {
      update(slot, Side::kRefresh, surfaces);
    } else {
      stale_unselected_.push_back(slot);
    }
  }
  stale_.clear();
  if (stale_unselected_.size() > 2 * size()) dropRepeats();
}

void MomentLevel::dropRepeats() {
  auto& slots = stale_unselected_;
  std::sort(slots.begin(), slots.end());
  slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
}

void MomentLevel::updateAll(SurfaceLevel& surfaces) {
  for (const auto* slots : {&stale_, &stale_unselected_}) {
    for (const uint32_t slot : *slots) {
      if (cells_[slot].stale) update(slot, Side::kKeep, surfaces);
    }
  }
  stale_.clear();
  stale_unselected_.clear();
}

void MomentLevel::select(uint32_t slot, bool selected, SurfaceLevel& surfaces) {
  if (cells_[slot].selected == selected) return;
  surfaces.setSelected(voxels_[slot], selected);
  for (uint32_t side = slot; side != Surface::kNone; side = surfaces.surface(side).back_surface) {
    cells_[side].selected = selected;
    if (selected) update(side, Side::kRefresh, surfaces);
  }
}

void MomentLevel::findFlatAxis(uint32_t slot) {
  const Shape shape(covarianceOf(cells_[slot], voxel_size_));
  const bool anchors = shape.flat && shape.patch > kLeastPatch;
  cells_[slot].flat_axis = anchors ? static_cast<int8_t>(shape.axis) : kNotFlat;
}

Moments MomentLevel::moments(uint32_t slot) const {
  const Cell& cell = cells_[slot];
  return {static_cast<double>(cell.count),
          {cell.sum[0], cell.sum[1], cell.sum[2]},
          symmetric(cell.outer)};
}

Eigen::Vector3d MomentLevel::normal(uint32_t slot) const {
  const Shape shape(covarianceOf(cells_[slot], voxel_size_));
  return shape.flat ? shape.normal : Eigen::Vector3d::Zero();
}

size_t MomentLevel::selectedSurfaces() const {
  size_t count = 0;
  for (uint32_t slot = 0; slot < size(); ++slot) count += cells_[slot].selected ? 1 : 0;
  return count;
}

}  // namespace edgevox
