// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversions/checked_transforms.hpp"

#include <cmath>
#include <limits>

#include "edgevox/io/number_text.hpp"
#include "ros/conversions/sensor_frames.hpp"
#include "ros/conversions/stamp.hpp"

namespace edgevox {
namespace {

using geometry_msgs::TransformStamped;
using Check = std::optional<TransformRefusal>;

constexpr double kFarthest = 1e8;         // [m]; the earth's centre is at 6.4e6 from its surface
constexpr double kNormTolerance = 10e-3;  // of a squared norm, as of tf2
constexpr double kNever = std::numeric_limits<double>::infinity();

Check checkFrames(const TransformStamped& transform) {
  const std::string parent = withoutSlash(transform.header.frame_id);
  const std::string child = withoutSlash(transform.child_frame_id);
  if (parent.empty() || child.empty()) return TransformRefusal{"no_frame", "a frame has no name"};
  if (parent == child) return TransformRefusal{"one_frame", "its two frames are one"};
  return std::nullopt;
}

Check checkTranslation(const TransformStamped& transform) {
  const auto& t = transform.transform.translation;
  for (const double metres : {t.x, t.y, t.z}) {
    if (std::abs(metres) <= kFarthest) continue;
    return TransformRefusal{"bad_translation",
                            "its translation has a component of " + shortText(metres) + " m"};
  }
  return std::nullopt;
}

Check checkRotation(const TransformStamped& transform) {
  const auto& q = transform.transform.rotation;
  const double squared = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  if (std::abs(squared - 1.0) < kNormTolerance) return std::nullopt;
  return TransformRefusal{
      "bad_rotation", "its quaternion is of norm " + shortText(std::sqrt(squared)) + ", not of 1"};
}

Check checkStamp(const TransformStamped& transform) {
  if (transform.header.stamp.isZero()) return std::nullopt;  // static, or a simulator begins
  const auto fault = faultOf(transform.header.stamp);
  if (!fault) return std::nullopt;
  return TransformRefusal{"bad_stamp", *fault};
}

Check checkAll(const TransformStamped& transform) {
  for (const auto check : {checkFrames, checkTranslation, checkRotation, checkStamp}) {
    if (Check refusal = check(transform)) return refusal;
  }
  return std::nullopt;
}

}  // namespace

std::string CheckedTransforms::staticParentOf(const std::string& frame) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = static_parents_.find(frame);
  return found == static_parents_.end() ? "" : found->second;
}

std::optional<TransformRefusal> CheckedTransforms::add(const TransformStamped& transform,
                                                       const std::string& authority,
                                                       bool is_static) {
  auto refusal = put(transform, authority, is_static);
  if (refusal) {
    refusal->text = "the transform from '" + transform.header.frame_id + "' to '" +
                    transform.child_frame_id + "' by " + authority +
                    " is refused: " + refusal->text + "; correct what publishes it";
  }
  return refusal;
}

std::optional<TransformRefusal> CheckedTransforms::put(const TransformStamped& transform,
                                                       const std::string& authority,
                                                       bool is_static) {
  if (auto refusal = checkAll(transform)) return refusal;
  const std::string child = withoutSlash(transform.child_frame_id);
  const std::lock_guard<std::mutex> lock(mutex_);
  // tf2 takes a frame that was on /tf before for one that moves, wherever it comes from.
  if ((!is_static || watches_.count(child) > 0) && isAhead(child, transform.header.stamp)) {
    return TransformRefusal{"leap", "its stamp is " + std::to_string(transform.header.stamp.sec) +
                                        " s, later than the one before by more than "
                                        "mapper/clock_leap, and not confirmed by a second one"};
  }
  try {
    buffer_.setTransform(transform, authority, is_static);
  } catch (const std::exception& error) {
    return TransformRefusal{"tf2", error.what()};
  }
  if (is_static) static_parents_[child] = withoutSlash(transform.header.frame_id);
  return std::nullopt;
}

bool CheckedTransforms::isAhead(const std::string& child, const ros::Time& stamp) {
  if (stamp.isZero()) return false;
  ClockWatch& watch = watches_.try_emplace(child, kNever, leap_).first->second;
  const ClockWatch::Order order = watch.check(stamp.toSec());
  if (order == ClockWatch::Order::kInTime) watch.accept(stamp.toSec());
  return order == ClockWatch::Order::kAhead;
}

void CheckedTransforms::clear() {
  const std::lock_guard<std::mutex> lock(mutex_);
  buffer_.clear();
  watches_.clear();
}

}  // namespace edgevox
