// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/edge_extractor_node.hpp"

#include <boost/make_shared.hpp>

#include "edgevox/stage_timer.hpp"
#include "nodes/scan_clouds.hpp"
#include "ros/conversions/voxel_scan_message.hpp"

namespace edgevox {
namespace {

constexpr size_t kSparseWindow = 100;  // scans

/// Puts the edges of `scan` into the message it was read from.
void setEdges(const VoxelScan& scan, const EdgeCount& count, VoxelScanStamped& message) {
  message.occupied_voxels = static_cast<uint32_t>(count.occupied);
  message.edge_voxels = static_cast<uint32_t>(count.edges);
  message.sparse_voxels = static_cast<uint32_t>(count.sparse);
  size_t i = 0;
  for (Voxel& voxel : message.voxels) {
    const bool is_next = isPossible(voxel, message.voxel_size);
    voxel.edge = static_cast<uint8_t>(is_next && scan.voxels[i].edge);
    if (is_next) ++i;
  }
}

}  // namespace

EdgeExtractorNode::EdgeExtractorNode(const ros::NodeHandle& handle,
                                     const ros::NodeHandle& private_handle, const std::string& name)
    : log_(name),
      parameters_(readNodeParameters(private_handle)),
      extractor_(parameters_.config.edges, parameters_.config.threads),
      edges_(ros::NodeHandle(handle).advertise<VoxelScanStamped>("edges", 10)),
      cloud_(ros::NodeHandle(handle).advertise<sensor_msgs::PointCloud2>("edges_cloud", 2)),
      density_monitor_(parameters_.config.edges, parameters_.config.threads, kSparseWindow),
      input_(handle, "voxels", parameters_.queue_size, log_,
             [this](const Input::Arrival& arrival) { process(arrival); }),
      diagnostics_(handle, private_handle, name,
                   [this](DiagnosticStatus& status) { diagnose(status); }) {
  input_.start();
}

void EdgeExtractorNode::process(const Input::Arrival& arrival) {
  const auto refusal = refusalOf(*arrival.message, parameters_.config);
  note(refusal);
  if (refusal) return;
  StageTimer timer(Clock::kWall);
  VoxelScan scan = fromMessage(*arrival.message);
  const EdgeCount count = extractor_.extract(scan);
  watchSparsity(scan, count);
  const double seconds = timer.lap();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    state_.last = count;
    state_.times.add(seconds);
  }
  if (edges_.getNumSubscribers() + cloud_.getNumSubscribers() == 0) return;
  const auto message = boost::make_shared<VoxelScanStamped>(*arrival.message);
  setEdges(scan, count, *message);
  message->extract_seconds = static_cast<float>(seconds);
  message->dropped += input_.dropped();
  addSettings(parameters_.config, {"edges/"}, *message);
  edges_.publish(message);
  if (cloud_.getNumSubscribers() > 0) cloud_.publish(cloudOf(*message, ScanPart::kEdges));
}

void EdgeExtractorNode::note(const std::optional<ScanRefusal>& refusal) {
  if (refusal) {
    log_.warn(refusal->reason, "scans from '" + input_.topic() + "' are refused: " + refusal->text);
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  state_.refusal = refusal;
  if (refusal) ++state_.refused[refusal->reason];
}

void EdgeExtractorNode::watchSparsity(const VoxelScan& scan, const EdgeCount& count) {
  std::unique_lock<std::mutex> lock(mutex_);
  density_monitor_.add(scan, count);
  const auto warning = density_monitor_.warning();
  lock.unlock();
  if (warning) log_.warn("too_sparse", textOf(*warning));
}

void EdgeExtractorNode::diagnose(DiagnosticStatus& status) {
  const InputReading reading = input_.reading();
  const std::lock_guard<std::mutex> lock(mutex_);
  status.summaryf(DiagnosticStatus::OK, "%zu edge voxels of %zu in a scan", state_.last.edges,
                  state_.last.occupied);
  if (state_.refusal) {
    status.summary(DiagnosticStatus::ERROR, "scans refused: " + state_.refusal->text);
  } else if (const auto warning = density_monitor_.warning()) {
    warn(textOf(*warning), status);
  } else if (state_.last.occupied > 0 && state_.last.edges == 0) {
    warn(
        "no edges in the last scan: it is flat, or voxel_size is smaller than the gap between "
        "scan lines",
        status);
  }
  addInput(reading, state_.dropped_told, status);
  status.add("occupied voxels of a scan", state_.last.occupied);
  status.add("edge voxels of a scan", state_.last.edges);
  status.addf("sparse voxels, median share", "%.3f", density_monitor_.share());
  for (const auto& [reason, count] : state_.refused) status.add("refused: " + reason, count);
  addTimes("extract", state_.times, status);
}

}  // namespace edgevox
