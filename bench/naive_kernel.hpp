// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "core/edges/dense_kernel.hpp"

namespace edgevox::bench {

/// Labels of a block of 16 voxels a side straight from the definition (Ryde et al. 2013, eq. 5),
/// with Sobel gradients and weights 1 4 6 4 1: at each target 125 gradients of 27 taps, weighted
/// and summed. Rows as for kernel::LabelBlock, with a halo of kernel::kHalo.
void labelBlockNaive(const uint64_t* occupied, const uint32_t* targets, uint32_t* edges,
                     const kernel::DenseThresholds& thresholds);

}  // namespace edgevox::bench
