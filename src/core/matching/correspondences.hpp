// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "edgevox/grid/voxel.hpp"
#include "edgevox/map/match_map.hpp"
#include "edgevox/matching/matcher.hpp"

namespace edgevox {

/// Normal equations of one Gauss-Newton step, on (translation in the map's axes, rotation vector
/// about the sensor).
struct NormalEquations {
  Matrix6 h = Matrix6::Zero();
  Vector6 b = Vector6::Zero();
  int matches = 0;
  double weight = 0.0;  // sum of the robust weights

  /// Residual e of a point `lever` from the sensor; J = [I, -[lever]x].
  void add(const Eigen::Matrix3d& w, const Eigen::Vector3d& e, const Eigen::Vector3d& lever);
  /// The same of a point that is `e` off a plane.
  void add(const Eigen::Vector3d& normal, double information, double e,
           const Eigen::Vector3d& lever);
  void finish() { h.bottomLeftCorner<3, 3>() = h.topRightCorner<3, 3>().transpose(); }
};

/// A plane, in the map frame.
struct PlaneInMap {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double offset = 0.0;       // along the normal, of its points [m]
  double information = 0.0;  // [1/m^2]; 0: there is none

  bool known() const { return information > 0; }
};

/// The first points of a sample that have something to match, each with what that is: the plane
/// that it is near, else the surfaces of level 1 around it.
class Correspondences {
 public:
  /// `wanted`: at most so many points. The map and the sample outlive it.
  Correspondences(const MatchMap& map, const ScanSample& sample, size_t wanted, bool all_voxels)
      : map_(map), sample_(sample), wanted_(wanted), all_voxels_(all_voxels) {
    near_.reserve(wanted);
  }

  /// Chooses the points anew, as the sample lies at `T_map_sensor`.
  void find(const Pose& T_map_sensor);
  /// The robust kernel is `widening` times as wide, squared. Points that have moved to another
  /// voxel are given what is there.
  NormalEquations linearise(const Pose& T_map_sensor, double widening);
  /// How well the directions of the pose are constrained, whatever the precision of the map: the
  /// mean of J^T N J over the points, where N is the square of the unit normal of what is matched,
  /// on (translation, rotation vector times `range` [m]).
  Matrix6 geometry(const Pose& T_map_sensor, double range) const;
  /// The same, with each point by its robust weight.
  Matrix6 fittingGeometry(const Pose& T_map_sensor, double range) const;

  uint64_t lookUps() const { return look_ups_; }

 private:
  struct NearPoint {
    Eigen::Vector3d point;  // in the sensor's frame
    SurfaceLevel::Around around;
    PlaneInMap plane;
  };

  bool lookUp(const Eigen::Vector3f& in_map, const Eigen::Vector3f& to_sensor,
              NearPoint& near) const;

  /// weightOf: of a squared distance in standard deviations.
  template <typename WeightOf>
  Matrix6 weightedGeometry(const Pose& T_map_sensor, double range, const WeightOf& weightOf) const;

  const MatchMap& map_;
  const ScanSample& sample_;
  size_t wanted_;
  bool all_voxels_;
  std::vector<NearPoint> near_;
  uint64_t look_ups_ = 0;
};

}  // namespace edgevox
