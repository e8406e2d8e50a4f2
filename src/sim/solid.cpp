// SPDX-License-Identifier: BSD-3-Clause
#include "sim/solid.hpp"

#include <algorithm>
#include <cmath>

namespace edgevox::sim {
namespace {

struct LocalRay {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

struct LocalHit {
  double range;
  Eigen::Vector3d normal;
};

// Where a line enters and leaves the slab |x| <= half along one axis.
struct SlabCrossing {
  double enter;
  double leave;
};

SlabCrossing crossSlab(double origin, double direction, double half) {
  const double inverse = safeInverse(direction);
  const double a = (-half - origin) * inverse;
  const double b = (half - origin) * inverse;
  return {std::min(a, b), std::max(a, b)};
}

std::optional<LocalHit> castBox(const LocalRay& ray, const Eigen::Vector3d& half) {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  int axis = 0;
  for (int i = 0; i < 3; ++i) {
    const SlabCrossing slab = crossSlab(ray.origin[i], ray.direction[i], half[i]);
    if (slab.enter > enter) {
      enter = slab.enter;
      axis = i;
    }
    leave = std::min(leave, slab.leave);
  }
  if (!(enter >= 0.0) || enter > leave) return std::nullopt;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  normal[axis] = ray.direction[axis] > 0.0 ? -1.0 : 1.0;
  return LocalHit{enter, normal};
}

std::optional<LocalHit> castCylinder(const LocalRay& ray, const Eigen::Vector3d& half) {
  const Eigen::Vector2d o = ray.origin.head<2>();
  const Eigen::Vector2d d = ray.direction.head<2>();
  const double a = d.squaredNorm();
  const double b = o.dot(d);
  const double c = o.squaredNorm() - half[0] * half[0];
  SlabCrossing side{-std::numeric_limits<double>::infinity(),
                    std::numeric_limits<double>::infinity()};
  if (a > 1e-18) {
    const double discriminant = b * b - a * c;
    if (discriminant < 0.0) return std::nullopt;
    const double root = std::sqrt(discriminant);
    side = {(-b - root) / a, (-b + root) / a};
  } else if (c > 0.0) {
    return std::nullopt;
  }
  const SlabCrossing caps = crossSlab(ray.origin.z(), ray.direction.z(), half.z());
  const bool through_cap = caps.enter > side.enter;
  const double enter = through_cap ? caps.enter : side.enter;
  if (!(enter >= 0.0) || enter > std::min(side.leave, caps.leave)) return std::nullopt;
  if (through_cap) {
    return LocalHit{enter, Eigen::Vector3d(0.0, 0.0, ray.direction.z() > 0.0 ? -1.0 : 1.0)};
  }
  const Eigen::Vector2d radial = (o + enter * d) / half[0];
  return LocalHit{enter, Eigen::Vector3d(radial.x(), radial.y(), 0.0)};
}

Eigen::Vector3d toLocal(const Solid& solid, const Eigen::Vector3d& point) {
  return solid.T_world_solid.linear().transpose() * (point - solid.T_world_solid.translation());
}

}  // namespace

double safeInverse(double value) { return 1.0 / (std::abs(value) > 1e-30 ? value : 1e-30); }

void Aabb::extend(const Aabb& other) {
  min = min.cwiseMin(other.min);
  max = max.cwiseMax(other.max);
}

bool Aabb::overlaps(const Aabb& other) const {
  return (min.array() <= other.max.array()).all() && (other.min.array() <= max.array()).all();
}

Aabb Aabb::inflated(double margin) const {
  return {min - Eigen::Vector3d::Constant(margin), max + Eigen::Vector3d::Constant(margin)};
}

double Aabb::surfaceArea() const {
  const Eigen::Vector3d size = (max - min).cwiseMax(0.0);
  return 2.0 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x());
}

Aabb Solid::aabb() const {
  const Eigen::Matrix3d axes = T_world_solid.linear();
  Eigen::Vector3d reach = axes.cwiseAbs() * half;
  if (shape == Shape::Cylinder) {
    const Eigen::Array3d along = axes.col(2).array();
    reach = half[2] * along.abs() + half[0] * (1.0 - along.square()).max(0.0).sqrt();
  }
  const Eigen::Vector3d centre = T_world_solid.translation();
  return {centre - reach, centre + reach};
}

std::optional<SurfaceHit> Solid::castRay(const Eigen::Vector3d& origin,
                                         const Eigen::Vector3d& direction) const {
  const LocalRay ray{toLocal(*this, origin), T_world_solid.linear().transpose() * direction};
  const auto hit = shape == Shape::Box ? castBox(ray, half) : castCylinder(ray, half);
  if (!hit) return std::nullopt;
  return SurfaceHit{hit->range, T_world_solid.linear() * hit->normal};
}

double Solid::signedDistance(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d local = toLocal(*this, point);
  if (shape == Shape::Box) {
    const Eigen::Vector3d beyond = local.cwiseAbs() - half;
    return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
  }
  const Eigen::Vector2d beyond(local.head<2>().norm() - half[0], std::abs(local.z()) - half[2]);
  return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
}

bool Solid::contains(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d local = toLocal(*this, point);
  if (shape == Shape::Box) return (local.cwiseAbs().array() <= half.array()).all();
  return local.head<2>().squaredNorm() <= half[0] * half[0] && std::abs(local.z()) <= half[2];
}

}  // namespace edgevox::sim
