// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/table.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "edgevox/io/number_text.hpp"

namespace edgevox {
namespace {

std::string joined(const std::vector<std::string>& texts, const char* between) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : between) + text;
  return all;
}

std::string markdownLine(const std::vector<std::string>& cells) {
  return "| " + joined(cells, " | ") + " |\n";
}

}  // namespace

Table::Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

bool Table::isText(const std::string& value) {
  return value.find_first_of(",\"|\n") == std::string::npos;
}

void Table::set(const std::string& column, double value) {
  const size_t position = positionOf(column);
  if (!std::isfinite(value)) return;
  rows_.back()[position] = {shortText(value), fixedText(value, columns_[position].decimals)};
}

void Table::set(const std::string& column, const std::string& value) {
  if (!isText(value)) throw std::invalid_argument("no text for a table: " + value);
  rows_.back()[positionOf(column)] = {value, value};
}

std::string Table::csv() const {
  std::string text;
  for (size_t i = 0; i < columns_.size(); ++i) text += (i == 0 ? "" : ",") + columns_[i].name;
  text += "\n";
  for (const auto& row : rows_) {
    for (size_t i = 0; i < row.size(); ++i) text += (i == 0 ? "" : ",") + row[i].csv;
    text += "\n";
  }
  return text;
}

std::string Table::markdown(const std::vector<std::string>& columns, size_t keys) const {
  std::vector<size_t> shown;
  for (const std::string& column : columns) {
    const size_t position = positionOf(column);
    if (!emptyColumn(position)) shown.push_back(position);
  }
  if (shown.size() <= keys) return "";
  std::vector<std::string> titles;
  for (const size_t position : shown) titles.push_back(columns_[position].title);
  std::string text =
      markdownLine(titles) + markdownLine(std::vector<std::string>(shown.size(), "---"));
  for (const auto& row : rows_) {
    const bool empty = std::all_of(shown.begin() + static_cast<std::ptrdiff_t>(keys), shown.end(),
                                   [&](size_t i) { return row[i].csv.empty(); });
    if (empty) continue;
    std::vector<std::string> cells;
    for (const size_t i : shown) cells.push_back(row[i].csv.empty() ? "-" : row[i].markdown);
    text += markdownLine(cells);
  }
  return text;
}

size_t Table::positionOf(const std::string& column) const {
  const auto found = std::find_if(columns_.begin(), columns_.end(),
                                  [&](const Column& known) { return known.name == column; });
  if (found == columns_.end()) throw std::out_of_range("no column is called " + column);
  return static_cast<size_t>(found - columns_.begin());
}

bool Table::emptyColumn(size_t position) const {
  return std::all_of(rows_.begin(), rows_.end(),
                     [&](const auto& row) { return row[position].csv.empty(); });
}

}  // namespace edgevox
