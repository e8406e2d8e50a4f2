// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/callback_queue.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <tf2_msgs/TFMessage.h>

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "ros/conversions/checked_transforms.hpp"
#include "ros/live/throttled_log.hpp"

namespace edgevox {

struct TransformReading {
  uint64_t refused = 0;
  std::string last_refusal;  ///< in words; empty if there is none
};

/// Listens to /tf and /tf_static in a thread of its own, as tf2_ros::TransformListener does, which
/// ends the process if a transform makes tf2 throw. Refused transforms are logged and counted.
class TransformInput {
 public:
  /// See CheckedTransforms. `log` must outlive this.
  TransformInput(const ros::NodeHandle& handle, const ros::Duration& cache, double leap,
                 ThrottledLog& log);
  ~TransformInput();
  TransformInput(const TransformInput&) = delete;
  TransformInput& operator=(const TransformInput&) = delete;

  const CheckedTransforms& transforms() const { return transforms_; }
  TransformReading reading() const;
  /// Forgets all transforms, for a clock that has jumped back.
  void clear() { transforms_.clear(); }

 private:
  using Event = ros::MessageEvent<tf2_msgs::TFMessage const>;

  ros::Subscriber subscribe(ros::NodeHandle handle, const std::string& topic, bool is_static);
  void listen();
  void receive(const Event& event, bool is_static);
  void watchClock();
  void note(const TransformRefusal& refusal);

  ThrottledLog& log_;
  CheckedTransforms transforms_;
  ros::Time last_;            // of the clock
  mutable std::mutex mutex_;  // of the reading
  TransformReading reading_;
  ros::CallbackQueue queue_;
  ros::Subscriber tf_;
  ros::Subscriber tf_static_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace edgevox
