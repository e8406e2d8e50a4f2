// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sstream>
#include <string>
#include <vector>

namespace edgevox::test {

/// Cells without the space around them.
using Row = std::vector<std::string>;

inline std::string trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// Of a line "| a | b |".
inline Row cellsOf(const std::string& line) {
  Row cells;
  std::istringstream in(line.substr(1));
  for (std::string cell; std::getline(in, cell, '|');) cells.push_back(trimmed(cell));
  return cells;
}

inline std::string lineOf(const Row& row) {
  std::string line = "|";
  for (const std::string& cell : row) line += (cell.empty() ? "" : " " + cell) + " |";
  return line + "\n";
}

/// The rows of the first table below a heading; none if it is not there.
inline std::vector<Row> tableBelow(const std::string& heading, const std::string& markdown) {
  std::vector<Row> rows;
  bool below = false;
  std::istringstream in(markdown);
  for (std::string line; std::getline(in, line);) {
    const bool in_table = !line.empty() && line.front() == '|';
    if (!in_table && !rows.empty()) break;
    if (!line.empty() && line.front() == '#') {
      below = trimmed(line.substr(line.find_first_not_of('#'))) == heading;
    }
    if (below && in_table) rows.push_back(cellsOf(line));
  }
  if (rows.size() > 1) rows.erase(rows.begin(), rows.begin() + 2);  // titles and rule
  return rows;
}

}  // namespace edgevox::test
