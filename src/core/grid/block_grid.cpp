// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/grid/block_grid.hpp"

#include <random>

namespace edgevox {

uint64_t hashSecret() {
  static const uint64_t secret = [] {
    std::random_device device;
    return uint64_t{device()} << 32 | device();
  }();
  return secret;
}

}  // namespace edgevox
