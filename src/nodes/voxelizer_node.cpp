// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/voxelizer_node.hpp"

#include <boost/make_shared.hpp>

#include "edgevox/stage_timer.hpp"
#include "nodes/scan_clouds.hpp"
#include "ros/conversions/voxel_scan_message.hpp"

namespace edgevox {

VoxelizerNode::VoxelizerNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                             const std::string& name)
    : log_(name),
      parameters_(readNodeParameters(private_handle)),
      voxelizer_(parameters_.config.voxelizer, parameters_.config.voxel_size),
      voxels_(ros::NodeHandle(handle).advertise<VoxelScanStamped>("voxels", 10)),
      cloud_(ros::NodeHandle(handle).advertise<sensor_msgs::PointCloud2>("voxels_cloud", 2)),
      input_(handle, "points", parameters_.queue_size, log_,
             [this](const Input::Arrival& arrival) { process(arrival); }),
      diagnostics_(handle, private_handle, name,
                   [this](DiagnosticStatus& status) { diagnose(status); }) {
  input_.start();
}

void VoxelizerNode::process(const Input::Arrival& arrival) {
  const CloudReading reading = readCloud(*arrival.message, parameters_.config.voxelizer);
  if (const auto* error = std::get_if<CloudError>(&reading)) return refuse(arrival, *error);
  const auto& cloud = std::get<CheckedCloud>(reading);
  if (!cloud.note.empty()) log_.warn("note", cloud.note);
  StageTimer timer(Clock::kWall);
  const VoxelScan scan = voxelizer_.voxelize(cloud.view);
  if (!scan.too_large.empty()) return refuse(arrival, {CloudFault::kTooLarge, scan.too_large});
  publish(scan, arrival, cloud, timer.lap());
}

void VoxelizerNode::refuse(const Input::Arrival& arrival, const CloudError& error) {
  log_.warn(toString(error.fault), "cloud " + std::to_string(arrival.number) + " from '" +
                                       input_.topic() + "' is refused: " + error.text);
  const std::lock_guard<std::mutex> lock(mutex_);
  ++state_.refused[toString(error.fault)];
  ++state_.refused_total;
  state_.last_refusal = error.text;
}

void VoxelizerNode::publish(const VoxelScan& scan, const Input::Arrival& arrival,
                            const CheckedCloud& cloud, double seconds) {
  const auto message =
      boost::make_shared<VoxelScanStamped>(toMessage(scan, arrival.message->header));
  message->number = arrival.number;
  message->time_field = cloud.time_field;
  message->arrival = ros::Time(arrival.time.sec, arrival.time.nsec);
  message->voxelize_seconds = static_cast<float>(seconds);
  message->dropped = input_.dropped();
  addSettings(parameters_.config, {"voxel_size", "voxelizer/"}, *message);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    message->refused = state_.refused_total;
    state_.dropped_points += scan.dropped;
    state_.note = cloud.note;
    state_.times.add(seconds);
  }
  voxels_.publish(message);
  if (cloud_.getNumSubscribers() > 0) cloud_.publish(cloudOf(*message, ScanPart::kAll));
}

void VoxelizerNode::diagnose(DiagnosticStatus& status) {
  const InputReading reading = input_.reading();
  const std::lock_guard<std::mutex> lock(mutex_);
  status.summaryf(DiagnosticStatus::OK, "clouds at %.1f Hz", reading.rate);
  addInput(reading, state_.dropped_told, status);
  if (state_.refused_total > state_.refused_told) {
    warn("clouds refused: " + state_.last_refusal, status);
  }
  state_.refused_told = state_.refused_total;
  if (!state_.note.empty()) warn(state_.note, status);
  status.add("refused", state_.refused_total);
  for (const auto& [reason, count] : state_.refused) status.add("refused: " + reason, count);
  status.add("points not finite", state_.dropped_points.not_finite);
  status.add("points too near", state_.dropped_points.too_near);
  status.add("points too far", state_.dropped_points.too_far);
  status.add("points with a wrong time", state_.dropped_points.bad_time);
  addTimes("voxelize", state_.times, status);
}

}  // namespace edgevox
