// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace edgevox {

/// One zstd frame that tells the size of its content.
std::string compressed(const std::string& bytes);
/// Of compressed(). Throws ArchiveError if it is damaged, or grows more than any map does.
std::string decompressed(const std::string& frame);

/// Bytes that an archive holds as a frame of their own.
struct PackedBytes {
  std::string bytes;

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& archive) {
    std::string frame;
    if constexpr (!Archive::kReads) frame = compressed(self.bytes);
    archive(frame);
    if constexpr (Archive::kReads) self.bytes = decompressed(frame);
  }
};

}  // namespace edgevox
