// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bag_index.hpp"

#include <algorithm>

namespace edgevox {
namespace {

const std::string kVersionLine = "#ROSBAG V2.0\n";
constexpr size_t kEntryBytes = 12;  // time and offset of a message
constexpr size_t kCountBytes = 8;   // connection and its number of messages

/// What the end of the bag tells about a chunk.
struct ChunkInfo {
  uint64_t at = 0;
  ros::Time start;
  std::map<uint32_t, uint32_t> counts;  ///< messages by connection
};

ros::Time timeAt(const void* bytes) {
  ros::Time time;
  time.sec = numberAt<uint32_t>(bytes);
  time.nsec = numberAt<uint32_t>(static_cast<const uint8_t*>(bytes) + sizeof time.sec);
  return time;
}

void requireVersion(BagFile& file) {
  const auto bytes = file.bytesAt(0, std::min<uint64_t>(file.size(), kVersionLine.size()));
  const std::string line(bytes.begin(), bytes.end());
  if (line == kVersionLine) return;
  if (line.compare(0, 4, "#ROS") == 0) {
    throw BagDamage("it is not of version 2.0; convert it with 'rosbag filter OLD NEW True'");
  }
  throw BagDamage("it does not begin as a bag");
}

BagRecord readFileHeader(BagFile& file) {
  BagRecord header = file.recordAt(kVersionLine.size(), BagOp::kFileHeader);
  if (header.fields.has("encryptor") && !header.fields.text("encryptor").empty()) {
    throw BagDamage("it is encrypted; decrypt it with 'rosbag decrypt'");
  }
  return header;
}

/// Gives the end of the record.
uint64_t readConnection(BagFile& file, uint64_t at, BagIndex& index) {
  const BagRecord record = file.recordAt(at, BagOp::kConnection);
  const auto data = file.bytesAt(record.data_at, record.data_size);
  const BagFields described(data.data(), data.size());
  index.connections.insert(
      {record.fields.number<uint32_t>("conn"),
       {record.fields.text("topic"), described.text("type"), described.text("md5sum")}});
  return record.end();
}

/// A file holds an entry of its index for each message, which limits the counts.
uint64_t readChunkInfo(BagFile& file, uint64_t at, const BagIndex& index, ChunkInfo& info) {
  const BagRecord record = file.recordAt(at, BagOp::kChunkInfo);
  const auto data = file.bytesAt(record.data_at, record.data_size);
  bool good = record.fields.number<uint32_t>("ver") == 1 &&
              data.size() == kCountBytes * size_t{record.fields.number<uint32_t>("count")};
  info.at = record.fields.number<uint64_t>("chunk_pos");
  const auto start = record.fields.number<uint64_t>("start_time");
  info.start = timeAt(&start);
  for (size_t i = 0; good && i < data.size(); i += kCountBytes) {
    const auto connection = numberAt<uint32_t>(&data[i]);
    const auto count = numberAt<uint32_t>(&data[i + 4]);
    good = index.connections.count(connection) > 0 && count <= file.size() / kEntryBytes;
    info.counts[connection] = count;
  }
  if (!good) throw BagDamage("the record at byte " + std::to_string(at) + ": its counts are wrong");
  return record.end();
}

/// Gives the end of the record.
uint64_t readEntries(BagFile& file, uint64_t at, const ChunkInfo& chunk,
                     std::vector<BagEntry>& entries) {
  const BagRecord record = file.recordAt(at, BagOp::kIndex);
  const auto connection = record.fields.number<uint32_t>("conn");
  const size_t count = record.fields.number<uint32_t>("count");
  if (record.fields.number<uint32_t>("ver") != 1 || chunk.counts.count(connection) == 0 ||
      record.data_size != kEntryBytes * count) {
    throw BagDamage("the record at byte " + std::to_string(at) + ": its counts are wrong");
  }
  const auto data = file.bytesAt(record.data_at, record.data_size);
  for (size_t i = 0; i < data.size(); i += kEntryBytes) {
    entries.push_back({timeAt(&data[i]), connection, chunk.at, numberAt<uint32_t>(&data[i + 8])});
  }
  return record.end();
}

/// The index of a chunk lies behind it, a record a connection.
std::vector<BagEntry> entriesOf(BagFile& file, const ChunkInfo& chunk) {
  std::vector<BagEntry> entries;
  uint64_t at = file.recordAt(chunk.at, BagOp::kChunk).end();
  for (size_t i = 0; i < chunk.counts.size(); ++i) at = readEntries(file, at, chunk, entries);
  return entries;
}

std::vector<BagEntry> unreadableEntries(const ChunkInfo& chunk) {
  std::vector<BagEntry> entries;
  for (const auto& [connection, count] : chunk.counts) {
    entries.resize(entries.size() + count, {chunk.start, connection, chunk.at, 0});
  }
  return entries;
}

void append(BagFile& file, const ChunkInfo& chunk, BagIndex& index) {
  std::vector<BagEntry> entries;
  try {
    entries = entriesOf(file, chunk);
  } catch (const BagDamage& damage) {
    index.damaged[chunk.at] = damage.what();
    entries = unreadableEntries(chunk);
  }
  index.entries.insert(index.entries.end(), entries.begin(), entries.end());
}

bool isChunkInfo(BagFile& file, uint64_t at) {
  try {
    file.recordAt(at, BagOp::kChunkInfo);
    return true;
  } catch (const BagDamage&) {
    return false;
  }
}

void sortEntries(std::vector<BagEntry>& entries) {
  std::stable_sort(entries.begin(), entries.end(), [](const BagEntry& a, const BagEntry& b) {
    return a.connection != b.connection ? a.connection < b.connection : a.received < b.received;
  });
}

}  // namespace

BagIndex readBagIndex(BagFile& file) {
  requireVersion(file);
  const BagRecord header = readFileHeader(file);
  auto at = header.fields.number<uint64_t>("index_pos");
  if (at == 0) throw BagDamage("it has no index: its recording did not end properly");
  BagIndex index;
  const auto connections = header.fields.number<uint32_t>("conn_count");
  for (uint32_t i = 0; i < connections; ++i) at = readConnection(file, at, index);
  const auto chunks = header.fields.number<uint32_t>("chunk_count");
  for (uint32_t i = 0; i < chunks; ++i) {
    ChunkInfo info;
    at = readChunkInfo(file, at, index, info);
    append(file, info, index);
  }
  if (isChunkInfo(file, at)) throw BagDamage("it has more chunks than its first record says");
  sortEntries(index.entries);
  return index;
}

}  // namespace edgevox
