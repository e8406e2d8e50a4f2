// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/posed_files.hpp"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <utility>

#include "edgevox/io/atomic_file.hpp"

namespace edgevox {
namespace {

bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// Where the number that begins at `at` ends; null if there is none.
const char* parseNumber(const char* at, [[maybe_unused]] const char* end, double& value) {
#ifdef __cpp_lib_to_chars  // more than twice as fast; since GCC 11
  const auto [after, fault] = std::from_chars(at, end, value);
  return fault == std::errc() ? after : nullptr;
#else
  char* after = nullptr;
  value = std::strtod(at, &after);
  return after == at ? nullptr : after;
#endif
}

}  // namespace

RecordedScan scanOf(std::vector<uint8_t> bytes, size_t point_step) {
  RecordedScan scan;
  scan.bytes = std::move(bytes);
  scan.view.frame = "lidar";
  scan.view.data = scan.bytes.data();
  scan.view.width = scan.bytes.size() / point_step;
  scan.view.height = 1;
  scan.view.point_step = point_step;
  scan.view.row_step = scan.view.width * point_step;
  return scan;
}

void refuse(const std::filesystem::path& file, const std::string& fault) {
  throw FileError("'" + file.string() + "' " + fault);
}

void refuseLine(const std::filesystem::path& file, size_t line, const std::string& fault) {
  throw FileError("'" + file.string() + "', line " + std::to_string(line) + ": " + fault);
}

const char* skipSpaces(const char* at, const char* end) {
  while (at != end && isSpace(*at)) ++at;
  return at;
}

const char* readNumber(const char* at, const char* end, double& value) {
  at = skipSpaces(at, end);
  if (at != end && *at == '+') ++at;
  if (at == end) return nullptr;
  const char* after = parseNumber(at, end, value);
  return after == end || (after != nullptr && isSpace(*after)) ? after : nullptr;
}

std::optional<std::vector<double>> numbersIn(const std::string& text) {
  std::vector<double> numbers;
  const char* end = text.data() + text.size();
  for (const char* at = skipSpaces(text.data(), end); at != end; at = skipSpaces(at, end)) {
    double value = 0.0;
    at = readNumber(at, end, value);
    if (at == nullptr || !std::isfinite(value)) return std::nullopt;
    numbers.push_back(value);
  }
  return numbers;
}

std::vector<NumberRow> readRows(const std::filesystem::path& file, size_t columns,
                                const std::string& meaning) {
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file)) {
    refuse(file, "cannot be read; it must hold " + meaning);
  }
  std::vector<NumberRow> rows;
  std::string text;
  for (size_t line = 1; std::getline(in, text); ++line) {
    auto numbers = numbersIn(text);
    if (numbers && numbers->empty()) continue;
    if (!numbers || numbers->size() != columns) {
      refuseLine(file, line,
                 "these are not " + std::to_string(columns) +
                     " finite numbers; the file must hold " + meaning);
    }
    rows.push_back({line, std::move(*numbers)});
  }
  if (in.bad()) refuse(file, "cannot be read to its end; check the disk");
  return rows;
}

}  // namespace edgevox
