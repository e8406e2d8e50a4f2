// SPDX-License-Identifier: BSD-3-Clause
#include "core/matching/correspondences.hpp"

#include <algorithm>

#include "edgevox/map/surface.hpp"

namespace edgevox {
namespace {

constexpr double kRobustScale = 9.0;         // squared Mahalanobis distance
constexpr double kFullInformation = 2500.0;  // of a surface across which a point is known [1/m^2]

double robustWeight(double scale, double squared_distance) {
  const double weight = scale / (scale + squared_distance);
  return weight * weight;
}

/// That of the finest voxel with one: where coarser ones have planes too, that is the flattest.
PlaneInMap planeAt(const MatchMap& map, const Eigen::Vector3f& point,
                   const Eigen::Vector3f& to_sensor) {
  for (int l = MatchMap::kFinestPlanes; l <= MatchMap::kCoarsestPlanes; ++l) {
    const PlaneLevel& level = map.planes(l);
    const VoxelIndex v = level.voxelOf(point);
    const Plane* plane = level.find(v, to_sensor);
    if (plane == nullptr) continue;
    const Eigen::Vector3d normal = plane->normal.cast<double>();
    return {normal,
            normal.dot(voxelCentre(v, level.voxelSize())) + static_cast<double>(plane->offset),
            static_cast<double>(plane->information)};
  }
  return {};
}

/// A point of the sample at a pose.
struct Placed {
  Eigen::Vector3d lever;  // from the sensor, in the map's axes
  Eigen::Vector3d in_map;
  Eigen::Vector3f in_map_f;
  Eigen::Vector3f to_sensor;  // unit vector

  Placed(const Pose& T_map_sensor, const Eigen::Vector3d& point)
      : lever(T_map_sensor.linear() * point),
        in_map(T_map_sensor.translation() + lever),
        in_map_f(in_map.cast<float>()),
        to_sensor(-lever.normalized().cast<float>()) {}
};

}  // namespace

void NormalEquations::add(const Eigen::Matrix3d& w, const Eigen::Vector3d& e,
                          const Eigen::Vector3d& lever) {
  Eigen::Matrix3d cross;
  cross << 0, -lever.z(), lever.y(), lever.z(), 0, -lever.x(), -lever.y(), lever.x(), 0;
  const Eigen::Matrix3d wc = w * cross;
  const Eigen::Vector3d we = w * e;
  h.topLeftCorner<3, 3>() += w;
  h.topRightCorner<3, 3>() -= wc;
  h.bottomRightCorner<3, 3>() -= cross * wc;
  b.head<3>() += we;
  b.tail<3>() += lever.cross(we);
  ++matches;
}

void NormalEquations::add(const Eigen::Vector3d& normal, double information, double e,
                          const Eigen::Vector3d& lever) {
  const Eigen::Vector3d turn = lever.cross(normal);
  const Eigen::Vector3d wn = information * normal;
  h.topLeftCorner<3, 3>() += wn * normal.transpose();
  h.topRightCorner<3, 3>() += wn * turn.transpose();
  h.bottomRightCorner<3, 3>() += information * turn * turn.transpose();
  b.head<3>() += e * wn;
  b.tail<3>() += information * e * turn;
  ++matches;
}

bool Correspondences::lookUp(const Eigen::Vector3f& in_map, const Eigen::Vector3f& to_sensor,
                             NearPoint& near) const {
  const SurfaceLevel& surfaces = map_.surfaces();
  near.plane = planeAt(map_, in_map, to_sensor);
  near.around.voxel = surfaces.voxelOf(in_map);
  if (near.plane.known()) return true;
  near.around = surfaces.around(near.around.voxel, all_voxels_);
  return near.around.count > 0;
}

void Correspondences::find(const Pose& T_map_sensor) {
  near_.clear();
  for (const Eigen::Vector3d& point : sample_) {
    if (near_.size() == wanted_) break;
    ++look_ups_;
    const Placed at(T_map_sensor, point);
    NearPoint near;
    near.point = point;
    if (lookUp(at.in_map_f, at.to_sensor, near)) near_.push_back(near);
  }
}

NormalEquations Correspondences::linearise(const Pose& T_map_sensor, double widening) {
  const SurfaceLevel& surfaces = map_.surfaces();
  const double scale = kRobustScale * widening;
  NormalEquations equations;
  look_ups_ += near_.size();
  for (NearPoint& near : near_) {
    const Placed at(T_map_sensor, near.point);
    if (surfaces.voxelOf(at.in_map_f) != near.around.voxel) {
      lookUp(at.in_map_f, at.to_sensor, near);
    }
    if (const PlaneInMap& plane = near.plane; plane.known()) {
      const double e = plane.normal.dot(at.in_map) - plane.offset;
      const double weight = robustWeight(scale, e * e * plane.information);
      equations.weight += weight;
      equations.add(plane.normal, weight * plane.information, e, at.lever);
      continue;
    }
    float distance = 0;
    const Surface* g = surfaces.nearest(near.around, at.in_map_f, at.to_sensor, distance);
    if (g == nullptr) continue;
    const double weight = robustWeight(scale, static_cast<double>(distance));
    equations.weight += weight;
    equations.add(symmetric(g->information) * weight, at.in_map - g->mean.cast<double>(), at.lever);
  }
  equations.finish();
  return equations;
}

/// Of a surface of level 1 the share of what a well known one says counts.
template <typename WeightOf>
Matrix6 Correspondences::weightedGeometry(const Pose& T_map_sensor, double range,
                                          const WeightOf& weightOf) const {
  NormalEquations sum;
  for (const NearPoint& near : near_) {
    const Placed at(T_map_sensor, near.point);
    const Eigen::Vector3d scaled = at.lever / std::max(range, at.lever.norm());
    if (const PlaneInMap& plane = near.plane; plane.known()) {
      const double e = plane.normal.dot(at.in_map) - plane.offset;
      sum.add(plane.normal, weightOf(e * e * plane.information), 0.0, scaled);
      continue;
    }
    float distance = 0;
    const Surface* g = map_.surfaces().nearest(near.around, at.in_map_f, at.to_sensor, distance);
    if (g == nullptr) continue;
    const double weight = weightOf(static_cast<double>(distance));
    sum.add(weight * (symmetric(g->information) / kFullInformation), Eigen::Vector3d::Zero(),
            scaled);
  }
  sum.finish();
  return sum.h / std::max(1, sum.matches);
}

Matrix6 Correspondences::geometry(const Pose& T_map_sensor, double range) const {
  return weightedGeometry(T_map_sensor, range, [](double) { return 1.0; });
}

Matrix6 Correspondences::fittingGeometry(const Pose& T_map_sensor, double range) const {
  return weightedGeometry(T_map_sensor, range,
                          [](double squared) { return robustWeight(kRobustScale, squared); });
}

}  // namespace edgevox
