// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "ros/live/input_monitor.hpp"
#include "ros/live/throttled_log.hpp"

namespace edgevox {

/// A subscription whose messages are handled one after another in a thread of its own, so that no
/// callback blocks. If more than `capacity` wait, the oldest is dropped and counted. The handler
/// may be called from start() to destruction: make this the last member.
template <typename Message>
class ScanInput {
 public:
  using Pointer = boost::shared_ptr<const Message>;
  struct Arrival {
    Pointer message;
    ros::WallTime time;
    uint64_t number = 0;  ///< counts the messages of the topic, from 0
  };
  using Handler = std::function<void(const Arrival&)>;

  ScanInput(const ros::NodeHandle& handle, const std::string& topic, int capacity,
            ThrottledLog& log, Handler handler)
      : handle_(handle),
        topic_(handle.resolveName(topic)),
        capacity_(static_cast<size_t>(capacity)),
        log_(log),
        handler_(std::move(handler)) {}

  /// From now to destruction the handler is called; before the first message `begin`, in the same
  /// thread. To be called once.
  void start(std::function<void()> begin = [] {}) {
    subscriber_ = handle_.subscribe<Message>(topic_, kTransportQueue, &ScanInput::receive, this,
                                             ros::TransportHints().tcpNoDelay());
    worker_ = std::thread([this, begin = std::move(begin)] {
      guarded("the node could not begin", begin);
      begun_ = true;
      work();
    });
  }

  ~ScanInput() {
    subscriber_.shutdown();
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      stopping_ = true;
    }
    arrived_.notify_all();
    if (worker_.joinable()) worker_.join();
  }
  ScanInput(const ScanInput&) = delete;
  ScanInput& operator=(const ScanInput&) = delete;

  const std::string& topic() const { return topic_; }
  bool stopping() const { return stopping_; }
  uint64_t dropped() const { return dropped_; }
  InputReading reading() const {
    InputReading reading = monitor_.read();
    reading.topic = topic_;
    reading.dropped = dropped_;
    return reading;
  }

 private:
  // The callback takes no time: messages wait in the queue here, where drops are counted.
  static constexpr uint32_t kTransportQueue = 100;

  void receive(const Pointer& message) {
    monitor_.arrived(message->header.stamp);
    bool full = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      full = waiting_.size() >= capacity_;
      if (full) {
        waiting_.pop_front();
        ++dropped_;
      }
      waiting_.push_back({message, ros::WallTime::now(), received_++});
    }
    arrived_.notify_one();
    if (!full || !begun_) return;
    log_.warn("dropped", "scans from '" + topic_ + "' are dropped, " + std::to_string(dropped_) +
                             " so far, as they come faster than they are used; choose a larger "
                             "voxel_size or a slower rate");
  }

  void work() {
    for (;;) {
      Arrival next;
      {
        std::unique_lock<std::mutex> lock(mutex_);
        arrived_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
        if (stopping_) return;
        next = std::move(waiting_.front());
        waiting_.pop_front();
      }
      guarded("scan " + std::to_string(next.number) + " from '" + topic_ + "' was given up",
              [&] { handler_(next); });
    }
  }

  template <typename Task>
  void guarded(const std::string& failure, const Task& task) {
    try {
      task();
    } catch (const std::exception& error) {
      log_.warn("exception", failure + ": " + error.what());
    }
  }

  ros::NodeHandle handle_;
  std::string topic_;
  size_t capacity_;
  ThrottledLog& log_;
  Handler handler_;
  InputMonitor monitor_;
  std::atomic<uint64_t> dropped_{0};
  std::atomic<bool> begun_{false};
  std::atomic<bool> stopping_{false};
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<Arrival> waiting_;
  uint64_t received_ = 0;
  std::thread worker_;
  ros::Subscriber subscriber_;
};

}  // namespace edgevox
