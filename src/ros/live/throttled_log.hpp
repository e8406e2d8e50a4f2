// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/time.h>

#include <map>
#include <mutex>
#include <string>

namespace edgevox {

/// Warnings by reason: the first at once, later ones at most every ten seconds of wall clock, with
/// their number. Safe to use from several threads.
class ThrottledLog {
 public:
  /// `node` stands before each text.
  explicit ThrottledLog(std::string node) : node_(std::move(node)) {}

  void warn(const std::string& reason, const std::string& text);

 private:
  struct Reason {
    ros::WallTime next;
    uint64_t unsaid = 0;
  };

  std::string node_;
  std::mutex mutex_;
  std::map<std::string, Reason> reasons_;
};

}  // namespace edgevox
