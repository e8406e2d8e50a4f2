// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/archive.hpp"

namespace edgevox {

void ArchiveReader::require(uint64_t count) const {
  if (count <= bytesLeft()) return;
  throw ArchiveError("it ends too early: " + std::to_string(count) + " bytes are missing at " +
                     std::to_string(at_) + " of " + std::to_string(bytes_.size()));
}

void ArchiveReader::requireEnd() const {
  if (bytesLeft() == 0) return;
  throw ArchiveError(std::to_string(bytesLeft()) + " bytes are left over");
}

void ArchiveReader::read(std::string& text) {
  uint64_t count = 0;
  readWord(count);
  require(count);
  text.assign(bytes_, at_, count);
  at_ += count;
}

}  // namespace edgevox
