// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace edgevox {

/// Named values in order, written as JSON or as a table to read.
class Report {
 public:
  void add(const std::string& name, double value);  ///< null if it is not finite
  void add(const std::string& name, uint64_t value);
  void add(const std::string& name, const std::string& value);
  void add(const std::string& name, const Report& group);
  void append(const Report& other);  ///< its values after those of this one

  std::string json() const { return jsonAt(0) + "\n"; }
  std::string table() const;

 private:
  struct Entry {
    std::string name;
    std::string value;          ///< as in JSON
    std::vector<Report> group;  ///< one or none
  };

  std::string jsonAt(int depth) const;
  void appendTable(const std::string& prefix, std::string& text) const;

  std::vector<Entry> entries_;
};

}  // namespace edgevox
