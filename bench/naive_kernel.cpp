// SPDX-License-Identifier: BSD-3-Clause
#include "naive_kernel.hpp"

#include <algorithm>
#include <vector>

#include <Eigen/Eigenvalues>

#include "core/edges/edge_kernel.hpp"

namespace edgevox::bench {
namespace {

constexpr int kSide = 16;
constexpr int kSpan = kSide + 2 * kernel::kHalo;
constexpr float kSmooth[3] = {1, 2, 1};
constexpr float kSlope[3] = {-1, 0, 1};
constexpr float kWeight[5] = {1, 4, 6, 4, 1};

/// 1 where occupied, else 0; x fastest.
using Occupancy = std::vector<float>;

Occupancy expand(const uint64_t* rows) {
  Occupancy occupancy(kSpan * kSpan * kSpan);
  for (size_t i = 0; i < occupancy.size(); ++i) {
    occupancy[i] = static_cast<float>((rows[i / kSpan] >> (i % kSpan)) & 1);
  }
  return occupancy;
}

const float* cellAt(const Occupancy& occupancy, int x, int y, int z) {
  return occupancy.data() + (z * kSpan + y) * kSpan + x;
}

Eigen::Vector3f gradientAt(const Occupancy& occupancy, int x, int y, int z) {
  float gx = 0;
  float gy = 0;
  float gz = 0;
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) {
      const float* row = cellAt(occupancy, x - 1, y + j - 1, z + k - 1);
      for (int i = 0; i < 3; ++i) {
        gx += row[i] * kSlope[i] * kSmooth[j] * kSmooth[k];
        gy += row[i] * kSmooth[i] * kSlope[j] * kSmooth[k];
        gz += row[i] * kSmooth[i] * kSmooth[j] * kSlope[k];
      }
    }
  }
  return {gx, gy, gz};
}

Eigen::Matrix3f tensorAt(const Occupancy& occupancy, int x, int y, int z) {
  Eigen::Matrix3f tensor = Eigen::Matrix3f::Zero();
  for (int k = 0; k < 5; ++k) {
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i < 5; ++i) {
        const Eigen::Vector3f g = gradientAt(occupancy, x + i - 2, y + j - 2, z + k - 2);
        tensor += kWeight[i] * kWeight[j] * kWeight[k] * g * g.transpose();
      }
    }
  }
  return tensor;
}

bool isEdge(const Eigen::Matrix3d& tensor, const kernel::DenseThresholds& thresholds) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(tensor, Eigen::EigenvaluesOnly);
  const double t = std::max(thresholds.magnitude, thresholds.rho * tensor.trace());
  const bool corner = solver.eigenvalues()[0] > t;
  return solver.eigenvalues()[1] > t && !(corner && thresholds.exclude_corners);
}

}  // namespace

void labelBlockNaive(const uint64_t* occupied, const uint32_t* targets, uint32_t* edges,
                     const kernel::DenseThresholds& thresholds) {
  const Occupancy occupancy = expand(occupied);
  for (int row = 0; row < kSide * kSide; ++row) {
    const int y = row % kSide + kernel::kHalo;
    const int z = row / kSide + kernel::kHalo;
    edges[row] = 0;
    for (uint32_t bits = targets[row]; bits != 0; bits &= bits - 1) {
      const int x = __builtin_ctz(bits);
      const Eigen::Matrix3f tensor = tensorAt(occupancy, x + kernel::kHalo, y, z);
      edges[row] |= static_cast<uint32_t>(isEdge(tensor.cast<double>(), thresholds)) << x;
    }
  }
}

}  // namespace edgevox::bench
