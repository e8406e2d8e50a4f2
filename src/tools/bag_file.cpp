// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bag_file.hpp"

#include <algorithm>

namespace edgevox {
namespace {

constexpr size_t kLength = sizeof(uint32_t);

}  // namespace

BagFields::BagFields(const uint8_t* bytes, size_t size) {
  for (size_t at = 0; at < size;) {
    const bool has_length = size - at >= kLength;
    const uint32_t length = has_length ? numberAt<uint32_t>(bytes + at) : 0;
    at += kLength;
    if (!has_length || length > size - at) throw BagDamage("the lengths of a header do not add up");
    const auto* field = reinterpret_cast<const char*>(bytes + at);
    const auto* end = field + length;
    const auto* equals = std::find(field, end, '=');
    if (equals == end) throw BagDamage("a header has a field without a name");
    fields_[std::string(field, equals)] = std::string(equals + 1, end);
    at += length;
  }
}

const std::string& BagFields::text(const std::string& name) const {
  const auto field = fields_.find(name);
  if (field == fields_.end()) throw BagDamage("a header has no field '" + name + "'");
  return field->second;
}

void BagFields::requireOp(BagOp op) const {
  if (number<uint8_t>("op") != static_cast<uint8_t>(op)) {
    throw BagDamage("there is a record of another kind");
  }
}

BagFile::BagFile(const std::string& name) : in_(name, std::ios::binary | std::ios::ate) {
  const std::streamoff end = in_.tellg();
  if (!in_ || end < 0) throw BagDamage("it cannot be opened");
  size_ = static_cast<uint64_t>(end);
}

std::vector<uint8_t> BagFile::bytesAt(uint64_t at, uint64_t size) {
  if (at > size_ || size > size_ - at) {
    throw BagDamage("the file ends too early, at byte " + std::to_string(size_));
  }
  std::vector<uint8_t> bytes(size);
  in_.clear();
  in_.seekg(static_cast<std::streamoff>(at));
  in_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!in_) throw BagDamage("byte " + std::to_string(at) + " cannot be read from the disk");
  return bytes;
}

BagRecord BagFile::recordAt(uint64_t at, BagOp op) {
  try {
    const auto header_size = numberAt<uint32_t>(bytesAt(at, kLength).data());
    const std::vector<uint8_t> header = bytesAt(at + kLength, uint64_t{header_size} + kLength);
    BagRecord record{BagFields(header.data(), header_size), at + kLength + header.size(),
                     numberAt<uint32_t>(header.data() + header_size)};
    record.fields.requireOp(op);
    if (record.end() > size_) throw BagDamage("its data reach beyond the end of the file");
    return record;
  } catch (const BagDamage& damage) {
    throw BagDamage("the record at byte " + std::to_string(at) + ": " + damage.what());
  }
}

}  // namespace edgevox
