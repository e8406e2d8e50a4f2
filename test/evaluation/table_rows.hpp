// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "evaluation/table.hpp"

namespace edgevox::test {

using Row = std::map<std::string, std::string>;  ///< values by their columns

inline std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line + ",");
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

inline std::vector<Row> rowsOf(const Table& table) {
  std::istringstream in(table.csv());
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> names = split(line);
  std::vector<Row> rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = split(line);
    Row& row = rows.emplace_back();
    for (size_t i = 0; i < names.size(); ++i) row[names[i]] = cells[i];
  }
  return rows;
}

inline double number(const Row& row, const std::string& column) {
  const std::string& text = row.at(column);
  EXPECT_FALSE(text.empty()) << column;
  return std::atof(text.c_str());
}

}  // namespace edgevox::test
