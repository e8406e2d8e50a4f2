// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace edgevox::test {

/// Handles messages until the condition holds; false if it does not within `seconds`.
bool waitFor(const std::function<bool()>& condition, double seconds = 20);

/// A command that runs beside the test, as if typed in `folder`, with its output in `log`. It ends
/// with the test.
class Process {
 public:
  Process(const std::vector<std::string>& command, const std::filesystem::path& folder,
          const std::filesystem::path& log);
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process();

  /// As Ctrl-C.
  void interrupt();

  bool waitForEnd(double seconds);

  /// Empty while it runs and if a signal has ended it.
  std::optional<int> exitCode() const { return exit_code_ < 0 ? std::nullopt : exit_code_; }

 private:
  bool hasEnded();

  pid_t pid_ = -1;
  std::optional<int> exit_code_;  // -1: by a signal
};

}  // namespace edgevox::test
