// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/map/surface.hpp"

#include <algorithm>

#include <Eigen/LU>

#include "core/map/extreme_eigenvalues.hpp"

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

constexpr double kCentroidPoints = 10.0;  // that the centroid of a voxel counts for

Eigen::Matrix3d covarianceOf(const Moments& moments, double size) {
  const double n = moments.count;
  const Eigen::Matrix3d scatter = moments.outer - moments.sum * moments.sum.transpose() / n;
  const double prior = kPriorWeight * kVoxelSigma * kVoxelSigma * size * size;
  return (scatter + prior * Eigen::Matrix3d::Identity()) / (n + kPriorWeight) +
         kSensorSigma * kSensorSigma * Eigen::Matrix3d::Identity();
}

/// Across the surface all of the information, along it only a share: the extent of what was seen
/// of a voxel would else fake a position, most of all in a corridor, where many flat voxels that
/// tell nothing outvote the few that do.
Eigen::Matrix3d informationOf(const SurfaceShape& shape) {
  const double share = std::min(kAlong, shape.thickness * shape.thickness / kFlat);
  const Eigen::Matrix3d all =
      shape.covariance.inverse() - Eigen::Matrix3d::Identity() / shape.greatest;
  return share * all + (1 - share) * shape.patch * shape.across;
}

/// See Surface::side: the normal turned to the viewer where the voxel is flat, the mean
/// viewing direction elsewhere.
Eigen::Vector3f sideOf(const SurfaceShape& shape, const Eigen::Vector3d& view) {
  if (!shape.flat) return sideOfRough(view.normalized());
  return sideOfFlat(shape.normal * (shape.normal.dot(view) < 0 ? -1.0 : 1.0));
}

Surface surfaceWith(const Eigen::Matrix3d& information, const Moments& moments, const VoxelIndex& v,
                    double size) {
  const Eigen::Matrix3f w = information.cast<float>();
  Surface surface;
  surface.mean = (voxelCentre(v, size) + moments.sum / moments.count).cast<float>();
  surface.information = {w(0, 0), w(1, 1), w(2, 2), w(0, 1), w(1, 2), w(2, 0)};
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

Eigen::Matrix3d symmetric(const std::array<float, 6>& m) {
  Eigen::Matrix3d out;
  out << m[0], m[3], m[5], m[3], m[1], m[4], m[5], m[4], m[2];
  return out;
}

SurfaceShape::SurfaceShape(const Moments& moments, double size)
    : covariance(covarianceOf(moments, size)) {
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

bool SurfaceShape::isPatch() const { return flat && patch > kLeastPatch; }

Eigen::Vector3f sideOfFlat(const Eigen::Vector3d& normal) {
  return (normal / kBehind).cast<float>();
}

Eigen::Vector3f sideOfRough(const Eigen::Vector3d& view) {
  return (view / kOpposite).cast<float>();
}

Surface surfaceOf(const Moments& moments, const VoxelIndex& v, double size,
                  const Eigen::Vector3d& view) {
  const SurfaceShape shape(moments, size);
  Surface surface = surfaceWith(informationOf(shape), moments, v, size);
  surface.side = sideOf(shape, view);
  return surface;
}

void addCentroid(const Eigen::Vector3d& centroid, Moments& moments) {
  moments += Moments::at(centroid, kCentroidPoints);
}

Surface surfaceOfCentroids(const Moments& moments, const VoxelIndex& v, double size) {
  return surfaceWith(informationOf(SurfaceShape(moments, size)), moments, v, size);
}

}  // namespace edgevox
