// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/list_option.hpp"

#include <algorithm>
#include <sstream>

#include "tools/options.hpp"

namespace edgevox {
namespace {

constexpr size_t kMostDigits = 5;

template <typename Value>
void addOnce(const Value& value, std::vector<Value>& values) {
  if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
}

size_t numberOf(const std::string& text, const std::string& option, size_t least) {
  const bool digits = !text.empty() && text.size() <= kMostDigits &&
                      text.find_first_not_of("0123456789") == std::string::npos;
  if (digits && std::stoul(text) >= least) return std::stoul(text);
  throw UsageError("--" + option + " takes whole numbers from " + std::to_string(least) +
                   " on, as in 1-3,7; not '" + text + "'");
}

}  // namespace

std::vector<std::string> wordsOf(const std::string& list, const std::string& option) {
  std::vector<std::string> words;
  std::istringstream in(list + ",");
  for (std::string word; std::getline(in, word, ',');) {
    if (word.empty()) throw UsageError("--" + option + " holds an empty word: '" + list + "'");
    addOnce(word, words);
  }
  return words;
}

std::vector<size_t> numbersOf(const std::string& list, const std::string& option, size_t least) {
  std::vector<size_t> numbers;
  for (const std::string& word : wordsOf(list, option)) {
    const size_t dash = word.find('-');
    const size_t first = numberOf(word.substr(0, dash), option, least);
    const size_t last =
        dash == std::string::npos ? first : numberOf(word.substr(dash + 1), option, least);
    if (last < first) throw UsageError("--" + option + ": '" + word + "' goes down");
    for (size_t number = first; number <= last; ++number) addOnce(number, numbers);
  }
  return numbers;
}

}  // namespace edgevox
