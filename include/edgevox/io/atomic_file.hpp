// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace edgevox {

/// A file that cannot be read or written; the text names it and tells why.
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A file that appears under its name only when it is complete: what is written goes to
/// temporary(), in the same folder, and keep() renames it. Without keep() nothing is left behind.
/// Any number of threads and processes may write the same target: one of their files stays.
class AtomicFile {
 public:
  /// Makes temporary(), empty. Throws FileError.
  explicit AtomicFile(std::filesystem::path target);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  const std::filesystem::path& temporary() const { return temporary_; }

  /// Brings the content to the disk and gives the file its name. Throws FileError.
  void keep();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  bool kept_ = false;
};

/// A file, or the names in a folder. Throws FileError.
void flushToDisk(const std::filesystem::path& file);

/// Throws FileError; then the file is as it was before.
void writeFile(const std::filesystem::path& target, const std::string& content);

}  // namespace edgevox
