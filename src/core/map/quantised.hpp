// SPDX-License-Identifier: BSD-3-Clause
// Numbers and directions in few bits, as files hold them.
#pragma once

#include <Eigen/Core>

namespace edgevox {

/// The nearest whole number from 0 to `greatest`, which is at most 255.
char byteOf(double value, double greatest);
double valueOf(char byte);

/// A unit vector as a point of an unfolded octahedron, both coordinates in [-1, 1].
Eigen::Vector2d unfolded(const Eigen::Vector3d& direction);
Eigen::Vector3d folded(const Eigen::Vector2d& p);

/// An information [1/m^2] in steps of a fifth; not above 0: 0.
char informationCode(double information);
double informationOf(char code);

}  // namespace edgevox
