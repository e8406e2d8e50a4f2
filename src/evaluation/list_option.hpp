// SPDX-License-Identifier: BSD-3-Clause
// Values of options that are lists.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace edgevox {

/// "a,b,c" as words, each once. Throws UsageError with the option's name if one is empty.
std::vector<std::string> wordsOf(const std::string& list, const std::string& option);

/// "1-3,7" as 1, 2, 3, 7, each once, in the order given. Throws UsageError with the option's name
/// if one is no whole number, is below `least` or above 99999, or if a range goes down.
std::vector<size_t> numbersOf(const std::string& list, const std::string& option, size_t least);

}  // namespace edgevox
