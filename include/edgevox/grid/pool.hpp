// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace edgevox {

/// A growing array whose elements never move.
template <typename T>
class Pool {
 public:
  Pool() = default;
  Pool(Pool&&) = default;
  Pool& operator=(Pool&&) = default;
  Pool(const Pool& other) : size_(other.size_) {
    for (const auto& chunk : other.chunks_) chunks_.push_back(std::make_unique<Chunk>(*chunk));
  }
  Pool& operator=(const Pool&) = delete;

  T& operator[](size_t i) { return (*chunks_[i / kChunk])[i % kChunk]; }
  const T& operator[](size_t i) const { return (*chunks_[i / kChunk])[i % kChunk]; }

  /// Appends a default-constructed element.
  T& grow() {
    if (size_ == chunks_.size() * kChunk) chunks_.push_back(std::make_unique<Chunk>());
    return (*this)[size_++];
  }

  size_t size() const { return size_; }
  size_t bytes() const { return chunks_.size() * sizeof(Chunk); }

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    uint64_t size = self.size();
    bytes(size);
    if constexpr (Archive::kReads) {
      self = {};
      bytes.require(size);  // every element is a byte at least
      for (uint64_t i = 0; i < size; ++i) bytes(self.grow());
    } else {
      for (size_t i = 0; i < size; ++i) bytes(self[i]);
    }
  }

 private:
  static constexpr size_t kChunk = 1024;
  using Chunk = std::array<T, kChunk>;

  std::vector<std::unique_ptr<Chunk>> chunks_;
  size_t size_ = 0;
};

}  // namespace edgevox
