// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace edgevox {

/// Where `subfolder` of this package lies, best first: by the running program in install or devel
/// space; if it is not there, where rospack finds the package.
std::vector<std::filesystem::path> packageFolders(const std::string& subfolder);

}  // namespace edgevox
