// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <tf2/buffer_core.h>

#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "edgevox/tracking/clock_watch.hpp"

namespace edgevox {

/// A transform that is not used.
struct TransformRefusal {
  std::string reason;  ///< one word
  std::string text;    ///< what is wrong, where, and what to do
};

/// A buffer for transforms from outside: what is not a rigid transform between two frames, with a
/// stamp that TF can carry, is kept out of it, as tf2 would throw, calculate with it, or drop
/// everything before a stamp that is wrong. Safe to use from several threads.
class CheckedTransforms {
 public:
  /// Keeps transforms for `cache`. In each frame a stamp later than the last one by more than
  /// `leap` [s] must be confirmed by a second one.
  CheckedTransforms(const ros::Duration& cache, double leap) : leap_(leap), buffer_(cache) {}

  const tf2::BufferCore& buffer() const { return buffer_; }
  /// Empty if none has been heard of.
  std::string staticParentOf(const std::string& frame) const;

  /// `authority` is who sent it. tf2 leaves out repeated and old ones by itself, with a message.
  std::optional<TransformRefusal> add(const geometry_msgs::TransformStamped& transform,
                                      const std::string& authority, bool is_static);
  /// Forgets all that is not static, for a clock that has jumped back.
  void clear();

 private:
  std::optional<TransformRefusal> put(const geometry_msgs::TransformStamped& transform,
                                      const std::string& authority, bool is_static);
  bool isAhead(const std::string& child, const ros::Time& stamp);

  double leap_;  // [s]
  tf2::BufferCore buffer_;
  mutable std::mutex mutex_;  // of all below
  std::map<std::string, ClockWatch> watches_;
  std::map<std::string, std::string> static_parents_;
};

}  // namespace edgevox
