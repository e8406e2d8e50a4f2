// SPDX-License-Identifier: BSD-3-Clause
#ifdef __AVX2__
#include "core/edges/edge_kernel_impl.hpp"
#else
#include "core/edges/edge_kernel.hpp"
#endif

namespace edgevox {
namespace kernel {

#ifdef __AVX2__
LabelBlock avx2LabelBlock(int block_edge) { return labelBlockFor(block_edge); }
#else
LabelBlock avx2LabelBlock(int /*block_edge*/) { return nullptr; }
#endif

}  // namespace kernel
}  // namespace edgevox
