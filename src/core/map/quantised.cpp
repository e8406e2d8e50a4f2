// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/quantised.hpp"

#include <algorithm>
#include <cmath>

namespace edgevox {
namespace {

constexpr double kOctaveSteps = 4.0;  // of the information
constexpr double kLeastOctave = -16.0;

double signOf(double v) { return v < 0 ? -1.0 : 1.0; }

}  // namespace

char byteOf(double value, double greatest) {
  const double clamped = std::min(std::max(std::round(value), 0.0), greatest);
  return static_cast<char>(static_cast<unsigned char>(clamped));
}

double valueOf(char byte) { return static_cast<double>(static_cast<unsigned char>(byte)); }

Eigen::Vector2d unfolded(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d p = direction / direction.cwiseAbs().sum();
  if (p.z() >= 0) return p.head<2>();
  return {(1 - std::abs(p.y())) * signOf(p.x()), (1 - std::abs(p.x())) * signOf(p.y())};
}

Eigen::Vector3d folded(const Eigen::Vector2d& p) {
  Eigen::Vector3d direction(p.x(), p.y(), 1 - std::abs(p.x()) - std::abs(p.y()));
  if (direction.z() < 0) {
    direction.x() = (1 - std::abs(p.y())) * signOf(p.x());
    direction.y() = (1 - std::abs(p.x())) * signOf(p.y());
  }
  return direction.normalized();
}

char informationCode(double information) {
  if (!(information > 0)) return '\0';
  return byteOf(1 + kOctaveSteps * (std::log2(information) - kLeastOctave), 255.0);
}

double informationOf(char code) {
  return code == '\0' ? 0.0 : std::exp2((valueOf(code) - 1) / kOctaveSteps + kLeastOctave);
}

}  // namespace edgevox
