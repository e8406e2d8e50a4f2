// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <random>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "edgevox/grid/voxel.hpp"

namespace edgevox::test {

/// A seeded stream of numbers; the standard's distributions differ between libraries, the engine
/// does not.
class Random {
 public:
  explicit Random(uint32_t seed) : engine_(seed) {}

  /// In [0, 1).
  double uniform() { return static_cast<double>(engine_()) * 0x1.0p-32; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  bool chance(double probability) { return uniform() < probability; }

  /// In [low, high].
  int32_t integer(int32_t low, int32_t high) {
    const auto count = static_cast<uint32_t>(high - low) + 1;
    return low + static_cast<int32_t>(engine_() % count);
  }

  /// Mean 0, standard deviation 1, within 6 of 0: the sum of twelve uniforms.
  double normal() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
  }

  Eigen::Vector3d normalVector() {
    const double x = normal();
    const double y = normal();
    return {x, y, normal()};
  }

  Eigen::Vector3d vectorIn(double low, double high) {
    const double x = uniform(low, high);
    const double y = uniform(low, high);
    return {x, y, uniform(low, high)};
  }

  VoxelIndex voxelIn(int32_t low, int32_t high) {
    const int32_t x = integer(low, high);
    const int32_t y = integer(low, high);
    return {x, y, integer(low, high)};
  }

  Eigen::Matrix3d rotation() {
    const Eigen::Vector3d axis = normalVector();
    return Eigen::Quaterniond(normal(), axis.x(), axis.y(), axis.z())
        .normalized()
        .toRotationMatrix();
  }

 private:
  std::mt19937 engine_;
};

}  // namespace edgevox::test
