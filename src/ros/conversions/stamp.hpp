// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/time.h>

#include <optional>
#include <string>

namespace edgevox {

/// Why TF, rosbag and ros::Duration cannot carry the stamp, for the end of a sentence; nothing if
/// they can. They throw, some on threads of their own, where its sum with a time to keep things
/// passes 2^32 s: the last year before that is refused. So is 0, which means that it was not set.
std::optional<std::string> faultOf(const ros::Time& stamp);

}  // namespace edgevox
