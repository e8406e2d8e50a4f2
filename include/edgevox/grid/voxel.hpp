// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace edgevox {

/// A rigid transform. `T_a_b` maps coordinates of frame b to frame a; metres.
using Pose = Eigen::Isometry3d;

/// Voxel (i, j, k) of size r covers [i r, (i+1) r) x [j r, (j+1) r) x [k r, (k+1) r).
struct VoxelIndex {
  int32_t x = 0;
  int32_t y = 0;
  int32_t z = 0;

  friend bool operator==(const VoxelIndex& a, const VoxelIndex& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  }
  friend bool operator!=(const VoxelIndex& a, const VoxelIndex& b) { return !(a == b); }
  friend bool operator<(const VoxelIndex& a, const VoxelIndex& b) {
    if (a.z != b.z) return a.z < b.z;
    if (a.y != b.y) return a.y < b.y;
    return a.x < b.x;
  }
  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.x, self.y, self.z);
  }
};

/// Every index that enters a grid lies in [-kIndexLimit, kIndexLimit); 52 km at 5 cm.
constexpr int32_t kIndexLimit = 1 << 20;

inline int32_t floorToInt(double v) {
  const auto i = static_cast<int32_t>(v);
  return i - static_cast<int32_t>(v < static_cast<double>(i));
}

/// Requires |coordinate * inverse_size| < 2^31.
template <typename Derived>
VoxelIndex voxelAt(const Eigen::MatrixBase<Derived>& point, double inverse_size) {
  return {floorToInt(static_cast<double>(point.x()) * inverse_size),
          floorToInt(static_cast<double>(point.y()) * inverse_size),
          floorToInt(static_cast<double>(point.z()) * inverse_size)};
}

inline Eigen::Vector3d voxelCentre(const VoxelIndex& v, double size) {
  return {(v.x + 0.5) * size, (v.y + 0.5) * size, (v.z + 0.5) * size};
}

/// The voxel 2^levels times as large that holds v.
inline VoxelIndex coarser(const VoxelIndex& v, int levels) {
  return {v.x >> levels, v.y >> levels, v.z >> levels};
}

/// The i-th of the kChildren voxels half as large in v: x first, then y, then z.
constexpr int kChildren = 8;
inline VoxelIndex childOf(const VoxelIndex& v, int i) {
  return {2 * v.x + (i & 1), 2 * v.y + ((i >> 1) & 1), 2 * v.z + ((i >> 2) & 1)};
}

inline bool inGridRange(const VoxelIndex& v) {
  const auto ok = [](int32_t i) { return i >= -kIndexLimit && i < kIndexLimit; };
  return ok(v.x) && ok(v.y) && ok(v.z);
}

/// Whether a point [m] is in the grid's range; false if it is not finite.
inline bool inGridRange(const Eigen::Vector3d& point, double voxel_size) {
  return (point.array().abs() < (kIndexLimit - 1) * voxel_size).all();
}

/// Whether a pose puts the origin in the grid's range; false if any of it is not finite.
inline bool inGridRange(const Pose& pose, double voxel_size) {
  return pose.matrix().allFinite() && inGridRange(Eigen::Vector3d(pose.translation()), voxel_size);
}

/// 21 bits an axis; unique for indices in the grid range.
inline uint64_t packedIndex(const VoxelIndex& v) {
  const auto bits = [](int32_t i) { return static_cast<uint64_t>(i + kIndexLimit); };
  return bits(v.x) | bits(v.y) << 21 | bits(v.z) << 42;
}

/// The inverse of packedIndex().
inline VoxelIndex unpackedIndex(uint64_t packed) {
  const auto index = [](uint64_t bits) {
    return static_cast<int32_t>(bits & (2 * kIndexLimit - 1)) - kIndexLimit;
  };
  return {index(packed), index(packed >> 21), index(packed >> 42)};
}

/// A bijective mix of 64 bits (the finalizer of SplitMix64).
inline uint64_t mixBits(uint64_t v) {
  v ^= v >> 30;
  v *= 0xbf58476d1ce4e5b9ULL;
  v ^= v >> 27;
  v *= 0x94d049bb133111ebULL;
  return v ^ (v >> 31);
}

inline uint64_t voxelHash(const VoxelIndex& v) { return mixBits(packedIndex(v)); }

/// A hash in [0, 1), the same for a voxel at all times.
inline double unitHash(const VoxelIndex& v) {
  return std::ldexp(static_cast<double>(voxelHash(v) >> 11), -53);
}

}  // namespace edgevox
