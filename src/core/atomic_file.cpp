// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
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

void flushToDisk(const std::filesystem::path& file, const std::filesystem::path& target) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail(target, errno);
  const int error = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  if (error != 0 && error != EINVAL) fail(target, error);  // EINVAL: not to be had here
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path target)
    : target_(std::move(target)),
      temporary_(target_.string() + ".part" + std::to_string(::getpid())) {}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!kept_) std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::keep() {
  flushToDisk(temporary_, target_);
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
