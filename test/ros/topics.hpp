// SPDX-License-Identifier: BSD-3-Clause
// Topics and services of the types that topics.cpp lists.
#pragma once

#include <ros/publisher.h>
#include <ros/subscriber.h>

#include <boost/shared_ptr.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace edgevox::test {

constexpr double kPatience = 20.0;  // [s of wall clock]

/// Whether the condition comes true in time.
bool eventually(const std::function<bool()>& condition);

/// Keeps all messages of a topic.
template <typename Message>
class Listener {
 public:
  using Pointer = boost::shared_ptr<const Message>;

  explicit Listener(const std::string& topic);

  std::vector<Pointer> messages() const;
  size_t count() const;
  bool waitFor(size_t number) const;

 private:
  void receive(const Pointer& message);

  mutable std::mutex mutex_;
  std::vector<Pointer> messages_;
  ros::Subscriber subscriber_;
};

template <typename Message>
ros::Publisher advertise(const std::string& topic, uint32_t queue_size, bool latch = false);

/// Listeners in this process get a message of their own.
template <typename Message>
void publish(const ros::Publisher& publisher, const Message& message);

/// Listeners in this process get this message.
template <typename Message>
void publishShared(const ros::Publisher& publisher, const boost::shared_ptr<const Message>& shared);

template <typename Message>
boost::shared_ptr<const Message> copyOf(const Message& message);

/// ros::service::call()
template <typename Service>
bool callService(const std::string& name, Service& service);

}  // namespace edgevox::test
