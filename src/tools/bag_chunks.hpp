// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "tools/bag_index.hpp"

namespace edgevox {

/// A message as it was sent.
struct MessageBytes {
  uint8_t* data = nullptr;
  uint32_t size = 0;
};

/// Reads messages out of the chunks of a bag, of which it keeps the last one unpacked.
class BagChunks {
 public:
  /// `file` and `index` must outlive this.
  BagChunks(BagFile& file, const BagIndex& index) : file_(file), index_(index) {}

  /// Valid until the next call. Throws BagDamage if the chunk cannot be unpacked or the message is
  /// not where the index says; whether its own bytes are right only packed chunks know.
  MessageBytes read(const BagEntry& entry);

 private:
  struct Free {
    void operator()(uint8_t* bytes) const { std::free(bytes); }
  };

  void load(uint64_t chunk);
  void unpack(const BagRecord& record);
  MessageBytes messageAt(const BagEntry& entry) const;

  BagFile& file_;
  const BagIndex& index_;
  uint64_t loaded_ = 0;  ///< [byte of the file], 0: none
  std::string fault_;    ///< of the loaded chunk, empty: none
  std::vector<uint8_t> stored_;
  std::unique_ptr<uint8_t, Free> unpacked_;
  uint8_t* bytes_ = nullptr;  ///< of one of them
  uint64_t size_ = 0;
};

}  // namespace edgevox
