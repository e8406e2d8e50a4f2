// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace edgevox {

/// The text that printf gives for "%.*f", whatever the size of the number.
std::string fixedText(double value, int decimals);

/// The text that printf gives for "%.*g": so many significant digits, without zeros at the end.
std::string shortText(double value, int digits = 6);

}  // namespace edgevox
