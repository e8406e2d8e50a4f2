// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/parameter.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>

#include "edgevox/io/number_text.hpp"

namespace edgevox {
namespace {

std::string rangeText(const Parameter& p) {
  if (const auto* choice = std::get_if<Choice>(&p.value)) {
    std::string words;
    for (const std::string& word : choice->words) words += (words.empty() ? "" : ", ") + word;
    return "one of " + words;
  }
  if (std::holds_alternative<bool*>(p.value)) return "true or false";
  const std::string whole = std::holds_alternative<int*>(p.value) ? "whole " : "";
  return "a " + whole + "number from " + shortText(p.min) + " to " + shortText(p.max) +
         (p.unit.empty() ? "" : " " + p.unit);
}

[[noreturn]] void reject(const Parameter& p, const std::string& text) {
  throw ConfigError("parameter '" + p.name + "' is '" + text + "'; it must be " + rangeText(p));
}

bool parse(const std::string& text, double& value) {
  char* end = nullptr;
  value = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0';
}

bool inRange(const Parameter& p, double value) { return value >= p.min && value <= p.max; }

void assignNumber(const Parameter& p, const std::string& text) {
  double value = 0;
  if (!parse(text, value) || !inRange(p, value)) reject(p, text);
  if (const auto* number = std::get_if<double*>(&p.value)) {
    **number = value;
    return;
  }
  if (value != std::floor(value)) reject(p, text);
  *std::get<int*>(p.value) = static_cast<int>(value);
}

std::string numberText(double value) {
  for (int digits = 1; digits <= std::numeric_limits<double>::max_digits10; ++digits) {
    const std::string text = shortText(value, digits);
    const bool scientific = text.find('e') != std::string::npos;
    if (scientific && std::abs(value) >= 1.0 && std::abs(value) < 1e7) continue;
    if (std::strtod(text.c_str(), nullptr) == value) return text;
  }
  return "nan";
}

size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = row[0]++;
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

void assign(const Parameter& p, const std::string& text) {
  if (const auto* choice = std::get_if<Choice>(&p.value)) {
    if (!choice->set(text)) reject(p, text);
  } else if (const auto* flag = std::get_if<bool*>(&p.value)) {
    if (text != "true" && text != "false") reject(p, text);
    **flag = text == "true";
  } else if (const auto* word = std::get_if<std::string*>(&p.value)) {
    **word = text;
  } else {
    assignNumber(p, text);
  }
}

void checkRange(const Parameter& p) {
  double value = p.min;
  if (const auto* number = std::get_if<double*>(&p.value)) value = **number;
  if (const auto* number = std::get_if<int*>(&p.value)) value = **number;
  if (!inRange(p, value)) reject(p, valueText(p));
}

std::string valueText(const Parameter& p) {
  if (const auto* choice = std::get_if<Choice>(&p.value)) return choice->get();
  if (const auto* flag = std::get_if<bool*>(&p.value)) return **flag ? "true" : "false";
  if (const auto* word = std::get_if<std::string*>(&p.value)) return **word;
  if (const auto* number = std::get_if<int*>(&p.value)) return std::to_string(**number);
  return numberText(*std::get<double*>(p.value));
}

std::string nearestName(const std::vector<Parameter>& parameters, const std::string& name) {
  const auto renamed = std::find_if(parameters.begin(), parameters.end(),
                                    [&](const Parameter& p) { return p.former_name == name; });
  if (renamed != parameters.end()) return renamed->name;
  const auto distance = [&](const Parameter& p) {
    const size_t slash = p.name.find('/');
    const std::string group = p.name.substr(0, slash);
    const std::string last = p.name.substr(slash + 1);  // the whole name if there is no slash
    return std::min(
        {editDistance(p.name, name), editDistance(group, name), editDistance(last, name)});
  };
  return std::min_element(
             parameters.begin(), parameters.end(),
             [&](const Parameter& a, const Parameter& b) { return distance(a) < distance(b); })
      ->name;
}

}  // namespace edgevox
