// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/io/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>

namespace edgevox {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, int error) {
  throw FileError("cannot write '" + file.string() +
                  "': " + std::generic_category().message(error) +
                  "; check that its folder exists, may be written to and has space left");
}

/// Makes a file beside the target that nobody else has, not even a process with the same id on
/// another machine.
std::filesystem::path makeTemporary(const std::filesystem::path& target) {
  static std::atomic<unsigned> count{0};
  while (true) {
    std::filesystem::path file = target;
    file += ".part" + std::to_string(::getpid()) + "_" + std::to_string(count++);
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) {
      ::close(descriptor);
      return file;
    }
    if (errno != EEXIST && errno != EINTR) fail(target, errno);
  }
}

}  // namespace

void flushToDisk(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail(file, errno);
  const int error = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  if (error != 0 && error != EINVAL) fail(file, error);  // EINVAL: not to be had here
}

AtomicFile::AtomicFile(std::filesystem::path target)
    : target_(std::move(target)), temporary_(makeTemporary(target_)) {}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!kept_) std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::keep() {
  flushToDisk(temporary_);
  std::error_code error;
  std::filesystem::rename(temporary_, target_, error);
  if (error) fail(target_, error.value());
  kept_ = true;
}

void writeFile(const std::filesystem::path& target, const std::string& content) {
  AtomicFile file(target);
  errno = 0;
  std::ofstream out(file.temporary(), std::ios::binary);
  out << content;
  out.close();
  if (!out) fail(target, errno == 0 ? EIO : errno);
  file.keep();
}

}  // namespace edgevox
