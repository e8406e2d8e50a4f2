// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "ros/conversions/checked_transforms.hpp"
#include "tools/bag_chunks.hpp"
#include "tools/bag_file.hpp"
#include "tools/bag_index.hpp"

namespace edgevox {

/// A bag that cannot be used; the text says why and what to do.
struct BagError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct RefusedTransforms {
  size_t count = 0;
  std::string first;  ///< what is wrong with it
};

/// A cloud, or why there is none.
struct BagCloud {
  sensor_msgs::PointCloud2::ConstPtr message;  ///< null: there is none
  const char* reason = "";  ///< "unreadable", or "undecodable": of another version
  std::string text;
};

/// What could not be read of a chunk.
struct BagLoss {
  std::string fault;  ///< the first one
  std::vector<size_t> clouds;
  size_t transforms = 0;  ///< messages
};

/// The losses in a line each, by the byte of the chunk.
std::vector<std::string> textsOf(const std::map<uint64_t, BagLoss>& losses);

/// The clouds of one topic and the transforms of a bag, read without a ROS master. What is damaged
/// is left out and told.
class BagReader {
 public:
  using ReadCloud = std::function<BagCloud()>;

  /// Without a topic the bag's only topic with clouds is taken. Throws BagError.
  BagReader(const std::string& file, const std::string& topic);

  const std::string& topic() const { return topic_; }
  size_t cloudCount() const { return clouds_.size(); }

  /// Reads /tf and /tf_static; the transforms that were refused, by reason, in words of the first.
  std::map<std::string, RefusedTransforms> readTransforms(CheckedTransforms& checked);

  /// Calls visit(index, read) for the clouds in the order of the bag, index from 0; read() gives
  /// the cloud, as long as visit runs.
  void forEachCloud(const std::function<void(size_t, const ReadCloud&)>& visit);

  /// What could not be had so far, by the byte of the chunk.
  const std::map<uint64_t, BagLoss>& losses() const { return losses_; }

 private:
  /// The entries in the order of their time.
  std::vector<BagEntry> entriesOn(const std::vector<std::string>& topics) const;
  const BagConnection& connectionOf(const BagEntry& entry) const;
  BagCloud readCloud(size_t index, const BagEntry& entry);
  BagLoss& lossAt(const BagEntry& entry, const std::string& fault);

  std::string name_;
  BagFile file_;
  BagIndex index_;
  BagChunks chunks_;
  std::string topic_;
  std::vector<BagEntry> clouds_;
  std::map<uint64_t, BagLoss> losses_;
};

}  // namespace edgevox
