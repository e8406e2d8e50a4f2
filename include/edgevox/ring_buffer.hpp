// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "edgevox/archive.hpp"

namespace edgevox {

/// The last values of a series, as many as it has room for. Memory is taken as they come.
template <typename T>
class RingBuffer {
 public:
  /// `capacity`: how many values there is room for, at least 1.
  explicit RingBuffer(size_t capacity) : capacity_(capacity) {}

  /// Puts the value in the place of the oldest one if there is no room left.
  void push(T value) {
    if (!isFull()) return values_.push_back(std::move(value));
    values_[oldest_] = std::move(value);
    oldest_ = (oldest_ + 1) % capacity_;
  }
  void clear() {
    values_.clear();
    oldest_ = 0;
  }

  size_t size() const { return values_.size(); }
  bool empty() const { return values_.empty(); }
  bool isFull() const { return values_.size() == capacity_; }
  /// The i-th value counted from the oldest one; i < size().
  const T& operator[](size_t i) const { return values_[(oldest_ + i) % values_.size()]; }
  /// The value that came first and the one that came last; there must be values.
  const T& oldest() const { return values_[oldest_]; }
  const T& newest() const { return (*this)[size() - 1]; }
  /// All values, in any order.
  const std::vector<T>& values() const { return values_; }

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.values_, self.oldest_);
    if constexpr (Archive::kReads) {
      if (self.values_.size() > self.capacity_ || self.oldest_ >= self.capacity_) {
        throw ArchiveError("a series of values is too long");
      }
    }
  }

 private:
  size_t capacity_;
  std::vector<T> values_;
  size_t oldest_ = 0;
};

}  // namespace edgevox
