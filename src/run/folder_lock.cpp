// SPDX-License-Identifier: BSD-3-Clause
#include "run/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "edgevox/io/atomic_file.hpp"

namespace edgevox {
namespace {

std::mutex without_locks;

bool lock(int descriptor) {
  while (::flock(descriptor, LOCK_EX) != 0) {
    if (errno != EINTR) return false;
  }
  return true;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0) {
    throw FileError("cannot open the folder '" + folder.string() +
                    "': " + std::generic_category().message(errno) + "; check its name and rights");
  }
  if (!lock(descriptor_)) instead_ = std::unique_lock<std::mutex>(without_locks);
}

FolderLock::~FolderLock() { ::close(descriptor_); }

}  // namespace edgevox
