// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "edgevox/grid/voxel.hpp"
#include "edgevox/scan/motion.hpp"

namespace edgevox {

inline bool areNear(const Pose& a, const Pose& b, double distance, double angle) {
  const Pose between = a.inverse() * b;
  return between.translation().norm() < distance && rotationAngle(between) < angle;
}

constexpr double kSameTranslation = 0.5;              // within which two matches are one answer [m]
constexpr double kSameRotation = 5.0 * M_PI / 180.0;  // the same [rad]

inline bool areOneAnswer(const Pose& a, const Pose& b) {
  return areNear(a, b, kSameTranslation, kSameRotation);
}

}  // namespace edgevox
