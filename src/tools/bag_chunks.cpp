// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bag_chunks.hpp"

#include <rosbag/chunked_file.h>

#include <exception>

namespace edgevox {
namespace {

constexpr uint64_t kLength = sizeof(uint32_t);

rosbag::CompressionType compressionOf(const std::string& name) {
  if (name == "bz2") return rosbag::compression::BZ2;
  if (name == "lz4") return rosbag::compression::LZ4;
  throw BagDamage("its compression is not known");
}

}  // namespace

MessageBytes BagChunks::read(const BagEntry& entry) {
  if (loaded_ != entry.chunk) load(entry.chunk);
  if (!fault_.empty()) throw BagDamage(fault_);
  return messageAt(entry);
}

void BagChunks::load(uint64_t chunk) {
  loaded_ = chunk;
  fault_.clear();
  try {
    const auto damaged = index_.damaged.find(chunk);
    if (damaged != index_.damaged.end()) throw BagDamage(damaged->second);
    const BagRecord record = file_.recordAt(chunk, BagOp::kChunk);
    stored_ = file_.bytesAt(record.data_at, record.data_size);
    bytes_ = stored_.data();
    size_ = stored_.size();
    if (record.fields.text("compression") != "none") unpack(record);
  } catch (const std::exception& error) {
    fault_ = error.what();
  }
}

void BagChunks::unpack(const BagRecord& record) {
  const auto compression = compressionOf(record.fields.text("compression"));
  const auto size = record.fields.number<uint32_t>("size");
  // Zeros that cost nothing until they are touched: a damaged size may be large.
  unpacked_.reset(static_cast<uint8_t*>(std::calloc(size_t{size} + 1, 1)));
  if (!unpacked_) throw BagDamage("there is no memory for its " + std::to_string(size) + " bytes");
  rosbag::ChunkedFile().decompress(compression, unpacked_.get(), size, stored_.data(),
                                   static_cast<unsigned>(stored_.size()));
  bytes_ = unpacked_.get();
  size_ = size;
}

MessageBytes BagChunks::messageAt(const BagEntry& entry) const {
  const auto require = [&](bool good) {
    if (good) return;
    throw BagDamage("there is no whole message at its byte " + std::to_string(entry.offset));
  };
  uint64_t at = entry.offset;
  require(at + kLength <= size_);
  const auto header_size = numberAt<uint32_t>(bytes_ + at);
  at += kLength;
  require(at + header_size + kLength <= size_);
  const BagFields header(bytes_ + at, header_size);
  header.requireOp(BagOp::kMessage);
  require(header.number<uint32_t>("conn") == entry.connection);
  at += header_size;
  const auto size = numberAt<uint32_t>(bytes_ + at);
  at += kLength;
  require(at + size <= size_);
  return {bytes_ + at, size};
}

}  // namespace edgevox
