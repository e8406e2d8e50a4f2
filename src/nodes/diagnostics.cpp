// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/diagnostics.hpp"

#include <utility>

namespace edgevox {
namespace {

constexpr double kPeriod = 1.0;   // [s]
constexpr double kSilence = 5.0;  // that is worth a warning [s]
constexpr double kMilliseconds = 1e3;

}  // namespace

NodeDiagnostics::NodeDiagnostics(const ros::NodeHandle& handle,
                                 const ros::NodeHandle& private_handle, const std::string& node,
                                 std::function<void(DiagnosticStatus&)> fill)
    : updater_(handle, private_handle, node) {
  updater_.setHardwareID("none");
  updater_.add("scans", std::move(fill));
  timer_ = handle.createWallTimer(ros::WallDuration(kPeriod),
                                  [this](const ros::WallTimerEvent&) { updater_.force_update(); });
}

void addInput(const InputReading& reading, uint64_t& last_dropped, DiagnosticStatus& status) {
  status.add("topic", reading.topic);
  status.add("received", reading.received);
  status.addf("rate [Hz]", "%.2f", reading.rate);
  if (reading.delay) {
    status.addf("delay [s]", "%.3f", *reading.delay);
  } else {
    status.add("delay [s]", "not known: the stamps are of another clock");
  }
  status.add("dropped", reading.dropped);
  if (ros::Time::isSimTime() && ros::Time::now().isZero()) {
    warn(
        "/use_sim_time is set but there is no /clock: play the bag with --clock, or for a live "
        "sensor 'rosparam set /use_sim_time false' and start again",
        status);
  }
  if (reading.silence > kSilence) {
    warn("nothing on '" + reading.topic + "' for " +
             std::to_string(static_cast<int>(reading.silence)) +
             " s: check the topic's name and that it is published (rostopic hz)",
         status);
  }
  if (reading.dropped > last_dropped) {
    warn(std::to_string(reading.dropped - last_dropped) +
             " scans dropped: they come faster than they are used; choose a larger voxel_size or a "
             "slower rate",
         status);
  }
  last_dropped = reading.dropped;
}

void addTransforms(const TransformReading& reading, uint64_t& told, DiagnosticStatus& status) {
  status.add("transforms refused", reading.refused);
  if (reading.refused > told) warn(reading.last_refusal, status);
  told = reading.refused;
}

void addTimes(const std::string& name, const RollingTimes& times, DiagnosticStatus& status) {
  status.addf(name + " median [ms]", "%.1f", kMilliseconds * times.quantile(0.5));
  status.addf(name + " p95 [ms]", "%.1f", kMilliseconds * times.quantile(0.95));
}

void warn(const std::string& text, DiagnosticStatus& status) {
  status.mergeSummary(DiagnosticStatus::WARN, text);
}

}  // namespace edgevox
