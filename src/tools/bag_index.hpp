// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/time.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tools/bag_file.hpp"

namespace edgevox {

struct BagConnection {
  std::string topic;
  std::string datatype;
  std::string md5sum;
};

/// Where a message lies.
struct BagEntry {
  ros::Time received;
  uint32_t connection = 0;
  uint64_t chunk = 0;   ///< [byte of the file]
  uint32_t offset = 0;  ///< [byte of the unpacked chunk]
};

struct BagIndex {
  std::map<uint32_t, BagConnection> connections;
  std::vector<BagEntry> entries;  ///< by connection and time
  /// Chunks without an index that can be read, by their bytes, with the reason. Their entries have
  /// the time of the chunk and no offset.
  std::map<uint64_t, std::string> damaged;
};

/// The index of a bag of version 2.0. Throws BagDamage if the index at the end of the bag cannot be
/// read, and if the bag has none, which its text says.
BagIndex readBagIndex(BagFile& file);

}  // namespace edgevox
