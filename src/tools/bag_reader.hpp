// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rosbag/bag.h>
#include <rosbag/message_instance.h>
#include <sensor_msgs/PointCloud2.h>

#include <cstddef>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>

#include "ros/checked_transforms.hpp"

namespace edgevox {

/// A bag that cannot be used; the text says why and what to do.
struct BagError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct RefusedTransforms {
  size_t count = 0;
  std::string first;  ///< what is wrong with it
};

/// The clouds of one topic and the transforms of a bag, read without a ROS master.
class BagReader {
 public:
  /// Without a topic the bag's only topic with clouds is taken. Throws BagError.
  BagReader(const std::string& file, const std::string& topic);

  const std::string& topic() const { return topic_; }
  size_t cloudCount() const { return cloud_count_; }

  /// Reads /tf and /tf_static; the transforms that were refused, by reason, in words of the first.
  std::map<std::string, RefusedTransforms> readTransforms(CheckedTransforms& checked);

  /// Calls visit(index, message) for the clouds in the order of the bag, index from 0.
  void forEachCloud(const std::function<void(size_t, const rosbag::MessageInstance&)>& visit);

  /// Null if the message cannot be decoded.
  static sensor_msgs::PointCloud2::ConstPtr decode(const rosbag::MessageInstance& message);

 private:
  std::string file_;
  std::string topic_;
  size_t cloud_count_ = 0;
  rosbag::Bag bag_;
};

}  // namespace edgevox
