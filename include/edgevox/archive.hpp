// SPDX-License-Identifier: BSD-3-Clause
// Values as little-endian bytes. A class names its members once, for writing and reading:
//   template <typename Self, typename Archive>
//   static void archive(Self& self, Archive& bytes) { bytes(self.a_, self.b_); }
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace edgevox {

/// Bytes that are not what they should be; the text says what is wrong.
struct ArchiveError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

namespace detail {

template <typename T>
using Word =
    std::conditional_t<sizeof(T) == 1, uint8_t,
                       std::conditional_t<sizeof(T) == 2, uint16_t,
                                          std::conditional_t<sizeof(T) == 4, uint32_t, uint64_t>>>;

template <typename T>
constexpr bool is_plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

}  // namespace detail

/// Appends values to a string of bytes.
class ArchiveWriter {
 public:
  static constexpr bool kReads = false;

  template <typename... Values>
  void operator()(const Values&... values) {
    (write(values), ...);
  }

  const std::string& bytes() const { return bytes_; }
  std::string take() { return std::move(bytes_); }

 private:
  template <typename T>
  void write(const T& value) {
    if constexpr (detail::is_plain<T>) {
      writeWord(value);
    } else {
      T::archive(value, *this);
    }
  }

  template <typename T>
  void writeWord(const T& value) {
    detail::Word<T> word;
    std::memcpy(&word, &value, sizeof(T));
    for (size_t i = 0; i < sizeof(T); ++i) {
      bytes_.push_back(static_cast<char>(static_cast<unsigned char>(word >> (8 * i))));
    }
  }

  template <typename Sequence>
  void writeSequence(const Sequence& values) {
    writeWord(uint64_t{values.size()});
    for (const auto& value : values) write(value);
  }

  void write(const std::string& text) { writeSequence(text); }
  template <typename T>
  void write(const std::vector<T>& values) {
    writeSequence(values);
  }
  template <typename T>
  void write(const std::deque<T>& values) {
    writeSequence(values);
  }
  template <typename T, size_t kSize>
  void write(const std::array<T, kSize>& values) {
    for (const T& value : values) write(value);
  }
  template <typename T>
  void write(const std::optional<T>& value) {
    writeWord(value.has_value());
    if (value) write(*value);
  }
  template <typename Scalar, int kRows, int kColumns>
  void write(const Eigen::Matrix<Scalar, kRows, kColumns>& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) writeWord(matrix.data()[i]);
  }
  void write(const Eigen::Isometry3d& pose) { write(pose.matrix()); }

  std::string bytes_;
};

/// Reads what an ArchiveWriter wrote. Throws ArchiveError at the end of the bytes; whatever they
/// are, no more memory is taken than a fixed multiple of their number.
class ArchiveReader {
 public:
  static constexpr bool kReads = true;

  /// `bytes` must outlive this.
  explicit ArchiveReader(const std::string& bytes) : bytes_(bytes) {}

  template <typename... Values>
  void operator()(Values&... values) {
    (read(values), ...);
  }

  size_t bytesLeft() const { return bytes_.size() - at_; }
  /// Throws ArchiveError unless all bytes have been read.
  void requireEnd() const;
  /// The same unless so many bytes are left.
  void require(uint64_t count) const;

 private:
  template <typename T>
  void read(T& value) {
    if constexpr (detail::is_plain<T>) {
      readWord(value);
    } else {
      T::archive(value, *this);
    }
  }

  template <typename T>
  void readWord(T& value) {
    require(sizeof(T));
    detail::Word<T> word = 0;
    for (size_t i = 0; i < sizeof(T); ++i) {
      const auto byte = static_cast<unsigned char>(bytes_[at_ + i]);
      word = static_cast<detail::Word<T>>(word | static_cast<detail::Word<T>>(byte) << (8 * i));
    }
    at_ += sizeof(T);
    if constexpr (std::is_same_v<T, bool>) {
      value = word != 0;
    } else {
      std::memcpy(&value, &word, sizeof(T));
    }
  }

  template <typename Sequence>
  void readSequence(Sequence& values) {
    uint64_t count = 0;
    readWord(count);
    require(count);  // every value is a byte at least
    values.clear();
    for (uint64_t i = 0; i < count; ++i) {
      values.emplace_back();
      read(values.back());
    }
  }

  void read(std::string& text);
  template <typename T>
  void read(std::vector<T>& values) {
    readSequence(values);
  }
  template <typename T>
  void read(std::deque<T>& values) {
    readSequence(values);
  }
  template <typename T, size_t kSize>
  void read(std::array<T, kSize>& values) {
    for (T& value : values) read(value);
  }
  template <typename T>
  void read(std::optional<T>& value) {
    bool has_value = false;
    readWord(has_value);
    value.reset();
    if (has_value) read(value.emplace());
  }
  template <typename Scalar, int kRows, int kColumns>
  void read(Eigen::Matrix<Scalar, kRows, kColumns>& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) readWord(matrix.data()[i]);
  }
  void read(Eigen::Isometry3d& pose) { read(pose.matrix()); }

  const std::string& bytes_;
  size_t at_ = 0;
};

}  // namespace edgevox
