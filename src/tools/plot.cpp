// SPDX-License-Identifier: BSD-3-Clause
#include "tools/plot.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "tools/package_files.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;

/// Beside the running program when installed, else in the source folder; empty if there is none.
fs::path findScript(const std::string& name) {
  std::error_code error;
  std::vector<fs::path> folders = {fs::read_symlink("/proc/self/exe", error).parent_path()};
  for (const fs::path& folder : packageFolders("scripts")) folders.push_back(folder);
  for (const fs::path& folder : folders) {
    if (fs::is_regular_file(folder / name)) return folder / name;
  }
  return {};
}

}  // namespace

bool runScript(const std::string& name, const std::vector<std::string>& arguments) {
  std::string program = findScript(name).string();
  if (program.empty()) return false;
  std::vector<std::string> words = arguments;
  std::vector<char*> argv = {program.data()};
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  if (posix_spawn(&child, program.c_str(), nullptr, nullptr, argv.data(), environ) != 0) {
    return false;
  }
  int status = 0;
  return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace edgevox
