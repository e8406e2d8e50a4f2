// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <functional>
#include <string>

#include "nodes/rolling_times.hpp"
#include "ros/live/input_monitor.hpp"
#include "ros/live/transform_input.hpp"

namespace edgevox {

using DiagnosticStatus = diagnostic_updater::DiagnosticStatusWrapper;

/// Publishes one status of a node to /diagnostics every second of wall clock, also while a
/// simulated clock stands still.
class NodeDiagnostics {
 public:
  NodeDiagnostics(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                  const std::string& node, std::function<void(DiagnosticStatus&)> fill);

 private:
  diagnostic_updater::Updater updater_;
  ros::WallTimer timer_;
};

/// Rate, delay and drops of an input; a warning if nothing comes, or if scans were dropped since
/// the last call, whose `dropped` it was.
void addInput(const InputReading& reading, uint64_t& last_dropped, DiagnosticStatus& status);

/// Transforms refused; a warning if there are more than at the last call, whose `told` it was.
void addTransforms(const TransformReading& reading, uint64_t& told, DiagnosticStatus& status);

/// Median and 95th percentile [ms].
void addTimes(const std::string& name, const RollingTimes& times, DiagnosticStatus& status);

void warn(const std::string& text, DiagnosticStatus& status);

}  // namespace edgevox
