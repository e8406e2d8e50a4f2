// SPDX-License-Identifier: BSD-3-Clause
#include "core/compression.hpp"

#include <zstd.h>

#include "edgevox/archive.hpp"

namespace edgevox {
namespace {

constexpr int kLevel = 19;              // the slowest but the ultra ones
constexpr size_t kFastFrom = 4U << 20;  // bytes: from here on time matters more
constexpr int kFastLevel = 3;
constexpr unsigned long long kMostGrowth = 4096;  // of the frame; more is no map

}  // namespace

std::string compressed(const std::string& bytes) {
  std::string frame(ZSTD_compressBound(bytes.size()), '\0');
  const int level = bytes.size() < kFastFrom ? kLevel : kFastLevel;
  const size_t size = ZSTD_compress(frame.data(), frame.size(), bytes.data(), bytes.size(), level);
  if (ZSTD_isError(size) != 0) throw ArchiveError(ZSTD_getErrorName(size));
  frame.resize(size);
  return frame;
}

std::string decompressed(const std::string& frame) {
  const unsigned long long size = ZSTD_getFrameContentSize(frame.data(), frame.size());
  if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR ||
      size > kMostGrowth * (frame.size() + 1)) {
    throw ArchiveError("a compressed part does not tell its size");
  }
  std::string bytes(size, '\0');
  const size_t got = ZSTD_decompress(bytes.data(), bytes.size(), frame.data(), frame.size());
  if (ZSTD_isError(got) != 0) throw ArchiveError(ZSTD_getErrorName(got));
  if (got != size) throw ArchiveError("a compressed part is shorter than it says");
  return bytes;
}

}  // namespace edgevox
