// SPDX-License-Identifier: BSD-3-Clause
#include "tools/console.hpp"

#include <ostream>

namespace edgevox {
namespace {

constexpr size_t kBarWidth = 40;

}  // namespace

void Console::print(const std::string& line) {
  eraseBar();
  out_ << line << std::endl;
}

void Console::showProgress(size_t done, size_t total) {
  if (total == 0) return;
  const std::string count = std::to_string(done) + " of " + std::to_string(total) + " " + unit_;
  if (terminal_) {
    const size_t filled = kBarWidth * done / total;
    out_ << "\r[" << std::string(filled, '#') << std::string(kBarWidth - filled, ' ') << "] "
         << count << std::flush;
    bar_shown_ = true;
    if (done == total) eraseBar();
  } else if (10 * done / total > tenths_) {
    tenths_ = 10 * done / total;
    out_ << count << std::endl;
  }
}

void Console::eraseBar() {
  if (bar_shown_) out_ << "\r\033[K" << std::flush;
  bar_shown_ = false;
}

}  // namespace edgevox
