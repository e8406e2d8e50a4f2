// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <mutex>

namespace edgevox {

/// Waits until no other FolderLock of the folder is left, in this process or another, and keeps
/// others out. Where the file system has no locks it keeps out those of this process only.
class FolderLock {
 public:
  /// The folder must exist. Throws FileError.
  explicit FolderLock(const std::filesystem::path& folder);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

 private:
  int descriptor_;
  std::unique_lock<std::mutex> instead_;
};

}  // namespace edgevox
