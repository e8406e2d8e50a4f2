// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace edgevox {

/// SHA-256 of files, 64 hexadecimal digits, by their names without a folder.
using Checksums = std::map<std::string, std::string>;

/// Throws FileError.
std::string sha256Of(const std::filesystem::path& file);

/// The text as sha256sum writes it.
std::string textOf(const Checksums& checksums);

/// Reads such a text. Throws FileError, also for a name that is not of a file beside it.
Checksums readChecksums(const std::filesystem::path& file);

}  // namespace edgevox
