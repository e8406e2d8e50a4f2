// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/surface_code.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "core/map/quantised.hpp"
#include "edgevox/archive.hpp"
#include "edgevox/map/surface.hpp"

namespace edgevox {
namespace {

constexpr double kMeanSteps = 64.0;  // a voxel
constexpr double kNormalSteps =
    126.0;  // even, so that axes are exact: from one end of an axis of the octahedron to the other
constexpr double kViewSteps = 30.0;
constexpr double kTurns = 32.0;     // half a turn
constexpr double kFlatSide = 10.0;  // longer is the side of a flat surface

enum Kind : char { kNoSide, kAlongNormal, kAgainstNormal, kView };

std::array<char, 2> directionCode(const Eigen::Vector3d& direction, double steps) {
  const Eigen::Vector2d p = unfolded(direction);
  return {byteOf((p.x() + 1) / 2 * steps, steps), byteOf((p.y() + 1) / 2 * steps, steps)};
}

Eigen::Vector3d directionOf(char x, char y, double steps) {
  return folded({2 * valueOf(x) / steps - 1, 2 * valueOf(y) / steps - 1});
}

/// Any one vector across another, the same at all times.
Eigen::Vector3d acrossOf(const Eigen::Vector3d& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().minCoeff(&axis);
  return normal.cross(Eigen::Vector3d::Unit(axis)).normalized();
}

char kindOf(const Surface& surface, const Eigen::Vector3d& normal) {
  const double length = static_cast<double>(surface.side.norm());
  if (!(length > 0)) return kNoSide;
  if (length < kFlatSide) return kView;
  return surface.side.cast<double>().dot(normal) > 0 ? kAlongNormal : kAgainstNormal;
}

}  // namespace

void SurfaceCode::add(const Surface& surface, const VoxelIndex& v, double size) {
  const Eigen::Vector3d in_voxel =
      surface.mean.cast<double>() / size - Eigen::Vector3d(v.x, v.y, v.z);
  for (size_t i = 0; i < mean.size(); ++i) {
    const double steps = std::floor(in_voxel[static_cast<Eigen::Index>(i)] * kMeanSteps);
    mean[i].bytes.push_back(byteOf(steps, kMeanSteps - 1));
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(symmetric(surface.information));
  const auto code = directionCode(solver.eigenvectors().col(2), kNormalSteps);
  normal[0].bytes.push_back(code[0]);
  normal[1].bytes.push_back(code[1]);
  const Eigen::Vector3d n = directionOf(code[0], code[1], kNormalSteps);
  const Eigen::Vector3d across = acrossOf(n);
  const Eigen::Vector3d second = solver.eigenvectors().col(1);
  const double angle = std::atan2(second.dot(n.cross(across)), second.dot(across));
  const double turns = std::fmod(std::round(angle / M_PI * kTurns) + kTurns, kTurns);
  turn.bytes.push_back(byteOf(turns, kTurns - 1));
  information[0].bytes.push_back(informationCode(solver.eigenvalues()[2]));
  information[1].bytes.push_back(informationCode(solver.eigenvalues()[1]));
  kind.bytes.push_back(kindOf(surface, n));
  const bool has_view = kind.bytes.back() == kView;
  const auto seen = has_view ? directionCode(surface.side.cast<double>().normalized(), kViewSteps)
                             : std::array<char, 2>{};
  view[0].bytes.push_back(seen[0]);
  view[1].bytes.push_back(seen[1]);
}

Surface SurfaceCode::surface(size_t i, const VoxelIndex& v, double size) const {
  for (const PackedBytes* series : {&mean[0], &mean[1], &mean[2], &normal[0], &normal[1], &turn,
                                    &information[0], &information[1], &kind, &view[0], &view[1]}) {
    if (i >= series->bytes.size()) throw ArchiveError("it lacks a surface");
  }
  Surface surface;
  const Eigen::Vector3d in_voxel(valueOf(mean[0].bytes[i]), valueOf(mean[1].bytes[i]),
                                 valueOf(mean[2].bytes[i]));
  surface.mean = (size * (Eigen::Vector3d(v.x, v.y, v.z) +
                          (in_voxel + Eigen::Vector3d::Constant(0.5)) / kMeanSteps))
                     .cast<float>();
  const Eigen::Vector3d n = directionOf(normal[0].bytes[i], normal[1].bytes[i], kNormalSteps);
  const Eigen::Vector3d across = acrossOf(n);
  const double angle = valueOf(turn.bytes[i]) * M_PI / kTurns;
  const Eigen::Vector3d second = std::cos(angle) * across + std::sin(angle) * n.cross(across);
  const Eigen::Matrix3f w = (informationOf(information[0].bytes[i]) * n * n.transpose() +
                             informationOf(information[1].bytes[i]) * second * second.transpose())
                                .cast<float>();
  surface.information = {w(0, 0), w(1, 1), w(2, 2), w(0, 1), w(1, 2), w(2, 0)};
  if (kind.bytes[i] == kAlongNormal) surface.side = sideOfFlat(n);
  if (kind.bytes[i] == kAgainstNormal) surface.side = sideOfFlat(-n);
  if (kind.bytes[i] == kView)
    surface.side = sideOfRough(directionOf(view[0].bytes[i], view[1].bytes[i], kViewSteps));
  return surface;
}

}  // namespace edgevox
