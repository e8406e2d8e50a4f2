// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/time.h>

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "edgevox/ring_buffer.hpp"

namespace edgevox {

struct InputReading {
  std::string topic;
  uint64_t received = 0;
  uint64_t dropped = 0;         ///< by the full queue
  double rate = 0.0;            ///< of the last messages [Hz]
  double silence = 0.0;         ///< since the last message, or since the start [s of wall clock]
  std::optional<double> delay;  ///< of the last stamp; none if it is of another clock [s]
};

/// Watches the arrival of messages. Safe to use from several threads.
class InputMonitor {
 public:
  InputMonitor() : last_(ros::WallTime::now()) {}

  void arrived(const ros::Time& stamp);
  InputReading read() const;

 private:
  static constexpr size_t kWindow = 30;

  mutable std::mutex mutex_;
  uint64_t received_ = 0;
  ros::WallTime last_;
  RingBuffer<ros::WallTime> arrivals_{kWindow};
  std::optional<double> delay_;
};

}  // namespace edgevox
