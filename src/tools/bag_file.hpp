// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace edgevox {

/// A place of a bag that cannot be read; the text tells the byte and the reason.
struct BagDamage : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Operations of records, by the description of the format 2.0.
enum class BagOp : uint8_t {
  kMessage = 2,
  kFileHeader = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7
};

/// A number at a place of a buffer; the format is little-endian, as are the machines of ROS 1.
template <typename Number>
Number numberAt(const void* bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof number);
  return number;
}

/// The fields of a record's header by name.
class BagFields {
 public:
  /// Throws BagDamage unless the lengths of the fields add up to `size`.
  BagFields(const uint8_t* bytes, size_t size);

  /// Throw BagDamage if there is no such field or, of a number, if it has another size.
  const std::string& text(const std::string& name) const;
  template <typename Number>
  Number number(const std::string& name) const {
    const std::string& field = text(name);
    if (field.size() != sizeof(Number)) throw BagDamage("field '" + name + "' has a wrong size");
    return numberAt<Number>(field.data());
  }
  bool has(const std::string& name) const { return fields_.count(name) > 0; }
  void requireOp(BagOp op) const;

 private:
  std::map<std::string, std::string> fields_;
};

/// A record of which only the header has been read.
struct BagRecord {
  BagFields fields;
  uint64_t data_at = 0;  ///< [byte of the file]
  uint32_t data_size = 0;

  uint64_t end() const { return data_at + data_size; }
};

/// A file of records. No length of it is trusted before it is known to end within the file.
class BagFile {
 public:
  /// Throws BagDamage if it cannot be opened.
  explicit BagFile(const std::string& name);

  uint64_t size() const { return size_; }
  /// Throw BagDamage.
  std::vector<uint8_t> bytesAt(uint64_t at, uint64_t size);
  BagRecord recordAt(uint64_t at, BagOp op);

 private:
  std::ifstream in_;
  uint64_t size_ = 0;
};

}  // namespace edgevox
