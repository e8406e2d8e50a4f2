// SPDX-License-Identifier: BSD-3-Clause
// Structure tensor labels of one block, in integers. Plain C types only: the file is compiled
// for several instruction sets, and no inline function may leak from one to the other.
#pragma once

#include <cstddef>
#include <cstdint>

namespace edgevox {
namespace kernel {

constexpr int kHalo = 3;             // gradient 1 + tensor 2; support 3
constexpr int64_t kPlane = 1 << 15;  // largest eigenvalue of an ideal plane, tensor >> 4
constexpr int kRatioBits = 16;       // fixed point of `rho`
constexpr int kSupportBits = 10;     // fixed point of `support`

struct Thresholds {
  int64_t magnitude;  ///< smallest middle eigenvalue of an edge, plane = kPlane
  int64_t rho;        ///< smallest middle eigenvalue / trace, << kRatioBits
  int64_t support;  ///< smallest eigenvalue of the neighbours' covariance, << kSupportBits; 0: off
  bool exclude_corners;  ///< Ryde et al. 2013: the smallest eigenvalue must not pass
  int64_t sparse;        ///< a voxel is sparse if all eigenvalues are below, plane = kPlane; 0: off
};

/// `occupied`: (edge + 2 kHalo)^2 rows, row (z + kHalo) * (edge + 2 kHalo) + y + kHalo, bit
/// x + kHalo. `targets`, `edges`: edge^2 rows of `edge` bits, targets a subset of the occupied.
/// Returns the number of sparse targets.
using LabelBlock = size_t (*)(const uint64_t* occupied, const uint32_t* targets, uint32_t* edges,
                              const Thresholds& thresholds);

/// The kernel for a block edge of 8, 16 or 32 that any processor can run.
LabelBlock portableLabelBlock(int block_edge);
/// The kernel in AVX2; null where AVX2 was not compiled in.
LabelBlock avx2LabelBlock(int block_edge);

}  // namespace kernel
}  // namespace edgevox
