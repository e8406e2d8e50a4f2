// SPDX-License-Identifier: BSD-3-Clause
#include "run/report.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "edgevox/io/number_text.hpp"

namespace edgevox {
namespace {

constexpr size_t kNameWidth = 28;

std::string quoted(const std::string& text) {
  std::string quote = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quote += std::string("\\") + c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      std::array<char, 8> code;
      std::snprintf(code.data(), code.size(), "\\u%04x", static_cast<unsigned>(c));
      quote += code.data();
    } else {
      quote += c;
    }
  }
  return quote + "\"";
}

}  // namespace

void Report::add(const std::string& name, double value) {
  entries_.push_back({name, std::isfinite(value) ? shortText(value) : "null", {}});
}

void Report::add(const std::string& name, uint64_t value) {
  entries_.push_back({name, std::to_string(value), {}});
}

void Report::add(const std::string& name, const std::string& value) {
  entries_.push_back({name, quoted(value), {}});
}

void Report::add(const std::string& name, const Report& group) {
  entries_.push_back({name, "", {group}});
}

void Report::append(const Report& other) {
  entries_.insert(entries_.end(), other.entries_.begin(), other.entries_.end());
}

std::string Report::jsonAt(int depth) const {
  if (entries_.empty()) return "{}";
  const std::string indent(2 * static_cast<size_t>(depth) + 2, ' ');
  std::string text = "{\n";
  for (const Entry& entry : entries_) {
    const bool last = &entry == &entries_.back();
    text += indent + quoted(entry.name) + ": " +
            (entry.group.empty() ? entry.value : entry.group.front().jsonAt(depth + 1)) +
            (last ? "\n" : ",\n");
  }
  return text + indent.substr(2) + "}";
}

std::string Report::table() const {
  std::string text;
  appendTable("", text);
  return text;
}

void Report::appendTable(const std::string& prefix, std::string& text) const {
  for (const Entry& entry : entries_) {
    const std::string name = prefix + entry.name;
    if (!entry.group.empty()) {
      entry.group.front().appendTable(name + "/", text);
    } else if (entry.value != "null") {
      text += "  " + name +
              std::string(name.size() < kNameWidth ? kNameWidth - name.size() : 1, ' ') +
              entry.value + "\n";
    }
  }
}

}  // namespace edgevox
