// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/edges/edge_direction.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Eigenvalues>

#include "core/grid/neighbourhood.hpp"

namespace edgevox {
namespace {

constexpr int kSide = 16;
constexpr int kHalo = 3;   // gradient 1 + tensor 2
constexpr int kReach = 2;  // of the tensor
constexpr int kSpan = kSide + 2 * kHalo;
constexpr std::array<int, 3> kSmooth = {1, 2, 1};
constexpr std::array<int, 5> kWeight = {1, 4, 6, 4, 1};

using Rows = Neighbourhood<kSide, kHalo>;

/// Sobel gradient of the occupancy; x, y, z from 1 to kSpan - 2.
Eigen::Vector3i gradientAt(const uint64_t* rows, int x, int y, int z) {
  Eigen::Vector3i gradient = Eigen::Vector3i::Zero();
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      const uint64_t bits = rows[(z + dz) * kSpan + y + dy] >> (x - 1);
      const int before = static_cast<int>(bits & 1);
      const int after = static_cast<int>((bits >> 2) & 1);
      const int along = before + 2 * static_cast<int>((bits >> 1) & 1) + after;
      const int smooth_y = kSmooth[static_cast<size_t>(dy + 1)];
      const int smooth_z = kSmooth[static_cast<size_t>(dz + 1)];
      gradient.x() += (after - before) * smooth_y * smooth_z;
      gradient.y() += along * dy * smooth_z;
      gradient.z() += along * smooth_y * dz;
    }
  }
  return gradient;
}

/// The structure tensor of the labeller (see edge_kernel), at a voxel of the block.
Eigen::Matrix3d tensorAt(const uint64_t* rows, const VoxelIndex& in_block) {
  Eigen::Matrix3i tensor = Eigen::Matrix3i::Zero();
  for (int dz = -kReach; dz <= kReach; ++dz) {
    for (int dy = -kReach; dy <= kReach; ++dy) {
      for (int dx = -kReach; dx <= kReach; ++dx) {
        const Eigen::Vector3i g = gradientAt(rows, in_block.x + kHalo + dx, in_block.y + kHalo + dy,
                                             in_block.z + kHalo + dz);
        const int weight = kWeight[static_cast<size_t>(dx + kReach)] *
                           kWeight[static_cast<size_t>(dy + kReach)] *
                           kWeight[static_cast<size_t>(dz + kReach)];
        tensor += weight * g * g.transpose();
      }
    }
  }
  return tensor.cast<double>();
}

Eigen::Vector3f directionOf(const Eigen::Matrix3d& tensor) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(tensor);
  const Eigen::Vector3f direction = solver.eigenvectors().col(0).cast<float>();
  const std::array<float, 3> order = {direction.z(), direction.y(), direction.x()};
  const auto* first =
      std::find_if(order.begin(), order.end(), [](float v) { return std::abs(v) > 1e-6F; });
  return first != order.end() && *first < 0 ? Eigen::Vector3f(-direction) : direction;
}

}  // namespace

std::vector<Eigen::Vector3f> edgeDirections(const BitGrid<16>& occupied,
                                            const std::vector<VoxelIndex>& voxels) {
  using Layout = BlockLayout<kSide>;
  std::vector<Eigen::Vector3f> directions;
  directions.reserve(voxels.size());
  std::optional<Rows> rows;
  VoxelIndex last;
  for (const VoxelIndex& v : voxels) {
    const VoxelIndex block = Layout::block(v);
    if (!rows || block != last) rows.emplace(occupied, block);
    last = block;
    directions.push_back(directionOf(
        tensorAt(rows->data(), {v.x & (kSide - 1), v.y & (kSide - 1), v.z & (kSide - 1)})));
  }
  return directions;
}

}  // namespace edgevox
