// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <utility>

namespace edgevox {

/// Messages and progress on one stream: a bar on a terminal, else a line every tenth of the way.
class Console {
 public:
  /// `unit` is what showProgress() counts.
  Console(std::ostream& out, bool terminal, std::string unit = "clouds")
      : out_(out), terminal_(terminal), unit_(std::move(unit)) {}

  void print(const std::string& line);
  void showProgress(size_t done, size_t total);

 private:
  void eraseBar();

  std::ostream& out_;
  bool terminal_;
  std::string unit_;
  bool bar_shown_ = false;
  size_t tenths_ = 0;
};

}  // namespace edgevox
