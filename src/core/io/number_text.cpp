// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/io/number_text.hpp"

#include <cstdio>

namespace edgevox {

std::string fixedText(double value, int decimals) {
  const int length = std::snprintf(nullptr, 0, "%.*f", decimals, value);
  std::string text(static_cast<size_t>(length) + 1, '\0');
  std::snprintf(&text[0], text.size(), "%.*f", decimals, value);
  text.pop_back();
  return text;
}

}  // namespace edgevox
