// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "edgevox/grid/voxel.hpp"

namespace edgevox {

/// Velocity of a body in its own frame: m/s, rad/s.
struct Twist {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.linear, self.angular);
  }
};

/// The rotation by |v| about v [rad].
Eigen::Matrix3d rotationOf(const Eigen::Vector3d& v);
Eigen::Vector3d rotationVector(const Eigen::Matrix3d& rotation);
double rotationAngle(const Pose& a_b);

/// Where the body is after `seconds`, in its frame at the start. The rotation is constant in the
/// body, the translation straight.
Pose moved(const Twist& twist, double seconds);
/// The same if it keeps on so, but for 2 s at most, either way.
Pose extrapolated(const Twist& twist, double seconds);
/// The motion that takes the body by `T_from_to` in `seconds`: the inverse of moved().
Twist twistOf(const Pose& T_from_to, double seconds);

/// Takes out what rounding adds to a rotation.
void renormalise(Pose& pose);

}  // namespace edgevox
