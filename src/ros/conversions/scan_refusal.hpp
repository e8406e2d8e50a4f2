// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace edgevox {

/// A scan that cannot be used.
struct ScanRefusal {
  std::string reason;  ///< one word
  std::string text;    ///< what is wrong, where, and what to do
};

}  // namespace edgevox
