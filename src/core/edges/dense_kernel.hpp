// SPDX-License-Identifier: BSD-3-Clause
// The structure tensor as dense separable correlations over one block, with any taps.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace edgevox {
namespace kernel {

/// Taps at -2..2.
struct DenseTaps {
  std::array<double, 5> slope;   ///< of a gradient along its own axis
  std::array<double, 5> smooth;  ///< of a gradient along the others
  std::array<double, 5> weight;  ///< of the sum over the 5^3 cube
};

/// Ryde et al. 2013, eq. 6 and 7 with h = 2.
DenseTaps paperTaps();
/// Sobel and binomial, those of the integer kernel.
DenseTaps integerTaps();

constexpr double kPaperPlane = 10.016;  // largest eigenvalue of an ideal plane, with paperTaps()
constexpr int kDenseHalo = 4;           // gradient 2 + tensor 2

struct DenseThresholds {
  double magnitude = 1.0;       ///< of the middle eigenvalue
  double rho = 0.0;             ///< of the middle eigenvalue / trace
  bool exclude_corners = true;  ///< the smallest eigenvalue must not pass
  double sparse = 0.0;          ///< a voxel is sparse if all eigenvalues are below; 0: off
};

/// Rows and result as for LabelBlock, with a halo of kDenseHalo. Real is float or double.
template <int kSide, typename Real>
size_t labelBlockDense(const uint64_t* occupied, const uint32_t* targets, uint32_t* edges,
                       const DenseTaps& taps, const DenseThresholds& thresholds);

}  // namespace kernel
}  // namespace edgevox
