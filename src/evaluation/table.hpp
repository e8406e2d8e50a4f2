// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace edgevox {

struct Column {
  std::string name;   ///< in CSV: no commas, no quotes
  std::string title;  ///< in Markdown
  int decimals = 2;   ///< in Markdown, of numbers
};

/// Rows of named values, written as CSV or, some of its columns at a time, as Markdown.
class Table {
 public:
  explicit Table(std::vector<Column> columns);

  void addRow() { rows_.emplace_back(columns_.size()); }
  /// Whether it can be set: it holds no comma, quote, bar or line end.
  static bool isText(const std::string& value);
  /// Sets a value in the last row. One that is not finite stays empty, as does one that is never
  /// set. Throws std::out_of_range for a column that is not known, std::invalid_argument for a text
  /// that cannot be set.
  void set(const std::string& column, double value);
  void set(const std::string& column, const std::string& value);

  size_t rows() const { return rows_.size(); }
  std::string csv() const;
  /// A table in Markdown of the columns named, of which the first `keys` say what a row is about
  /// and are never empty. Columns and rows that hold nothing else are left out; "" if nothing is
  /// left.
  std::string markdown(const std::vector<std::string>& columns, size_t keys) const;

 private:
  struct Value {
    std::string csv;
    std::string markdown;
  };

  size_t positionOf(const std::string& column) const;
  bool emptyColumn(size_t position) const;

  std::vector<Column> columns_;
  std::vector<std::vector<Value>> rows_;
};

}  // namespace edgevox
