// SPDX-License-Identifier: BSD-3-Clause
// What the readers of folders of scans have in common.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/placed_scan.hpp"
#include "evaluation/recorded_scan.hpp"

namespace edgevox {

/// A scan that has not been read yet.
struct PosedFile {
  std::filesystem::path file;
  double stamp = 0.0;  ///< [s]
  TruePose truth;
};

struct ScanFolder {
  std::filesystem::path folder;
  std::filesystem::path poses;               ///< as given; empty: they are in the folder
  std::vector<std::filesystem::path> scans;  ///< at least one, in natural order of their names
};

/// Points one after the other that begin with x, y and z as float32 [m], as a cloud without a pose.
RecordedScan scanOf(std::vector<uint8_t> bytes, size_t point_step);

/// Throws FileError with the file's name and `fault`, which says what to do.
[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& fault);
[[noreturn]] void refuseLine(const std::filesystem::path& file, size_t line,
                             const std::string& fault);

/// Where the next word of a line begins, or `end`.
const char* skipSpaces(const char* at, const char* end);

/// Reads the first word of a text that ends with '\0' at `end`. Gives where the word ends, or null
/// if it is no number.
const char* readNumber(const char* at, const char* end, double& value);

/// The finite numbers that a text consists of; none if there is anything else.
std::optional<std::vector<double>> numbersIn(const std::string& text);

struct NumberRow {
  size_t line = 0;  ///< of the file, counted from 1
  std::vector<double> numbers;
};

/// The lines of a file without the empty ones. Throws FileError unless each has `columns` finite
/// numbers; `meaning` tells what these are.
std::vector<NumberRow> readRows(const std::filesystem::path& file, size_t columns,
                                const std::string& meaning);

}  // namespace edgevox
