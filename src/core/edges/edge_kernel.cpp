// SPDX-License-Identifier: BSD-3-Clause
#include "core/edges/edge_kernel_impl.hpp"

namespace edgevox {
namespace kernel {

LabelBlock portableLabelBlock(int block_edge) { return labelBlockFor(block_edge); }

}  // namespace kernel
}  // namespace edgevox
