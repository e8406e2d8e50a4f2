// SPDX-License-Identifier: BSD-3-Clause
#include "tools/package_files.hpp"

#include <ros/package.h>

#include <fstream>
#include <sstream>

namespace edgevox {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPackage = "edgevox";

/// PREFIX of PREFIX/lib/<package>/<program>.
fs::path prefixOfProgram() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path().parent_path().parent_path();
}

/// The source folders of a devel space, which catkin lists in its file .catkin.
std::vector<fs::path> sourceFolders(const fs::path& devel) {
  std::vector<fs::path> folders;
  std::ifstream in(devel / ".catkin");
  std::string line;
  std::getline(in, line);
  std::istringstream entries(line);
  for (std::string entry; std::getline(entries, entry, ';');) {
    folders.emplace_back(entry);
    folders.push_back(fs::path(entry) / kPackage);
  }
  return folders;
}

}  // namespace

std::vector<fs::path> packageFolders(const std::string& subfolder) {
  const fs::path prefix = prefixOfProgram();
  std::vector<fs::path> packages = {prefix / "share" / kPackage};
  for (const fs::path& folder : sourceFolders(prefix)) packages.push_back(folder);

  std::vector<fs::path> existing;
  for (const fs::path& package : packages) {
    if (fs::is_directory(package / subfolder)) existing.push_back(package / subfolder);
  }
  if (!existing.empty()) return existing;
  const fs::path found = ros::package::getPath(kPackage);
  if (!found.empty() && fs::is_directory(found / subfolder)) existing.push_back(found / subfolder);
  return existing;
}

}  // namespace edgevox
