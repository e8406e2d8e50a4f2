// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/io/number_text.hpp"

#include <cstdio>

namespace edgevox {

namespace {

std::string printed(const char* format, int precision, double value) {
  const int length = std::snprintf(nullptr, 0, format, precision, value);
  std::string text(static_cast<size_t>(length) + 1, '\0');
  std::snprintf(&text[0], text.size(), format, precision, value);
  text.pop_back();
  return text;
}

}  // namespace

std::string fixedText(double value, int decimals) { return printed("%.*f", decimals, value); }

std::string shortText(double value, int digits) { return printed("%.*g", digits, value); }

}  // namespace edgevox
