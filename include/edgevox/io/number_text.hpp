// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace edgevox {

/// As printf's "%.*f", whatever the size of the number.
std::string fixedText(double value, int decimals);

}  // namespace edgevox
