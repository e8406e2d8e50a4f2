// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cloud_mapping.hpp"

#include "edgevox/stage_timer.hpp"
#include "run/scan_advice.hpp"

namespace edgevox {
namespace {

constexpr const char* kWayOut =
    "use all clouds (--stride 1), an odometry (--odom-frame), or a larger voxel_size";

}  // namespace

CloudMapping::CloudMapping(const Config& config, const SensorFrames& frames, Console& console)
    : config_(config.voxelizer), transformer_(frames), console_(console), pipeline_(config) {}

void CloudMapping::add(size_t index, const BagCloud& cloud) {
  if (!cloud.message) return leaveOut(index, cloud.reason, cloud.text);
  const CloudReading reading = readCloud(*cloud.message, config_);
  if (const auto* error = std::get_if<CloudError>(&reading)) {
    return leaveOut(index, toString(error->fault), error->text);
  }
  const auto transforms = transformer_.transformsOf(cloud.message->header);
  if (const auto* refusal = std::get_if<ScanRefusal>(&transforms)) {
    return leaveOut(index, refusal->reason, refusal->text);
  }
  process(index, std::get<CheckedCloud>(reading), std::get<ScanTransforms>(transforms));
}

void CloudMapping::leaveOut(size_t cloud, const std::string& reason, const std::string& text) {
  if (++run_.left_out[reason] > 1) return;
  console_.print("cloud " + std::to_string(cloud) + " is left out: " + text +
                 ". More of this kind are counted only.");
}

void CloudMapping::process(size_t cloud, const CheckedCloud& checked,
                           const ScanTransforms& transforms) {
  printNote(checked.note);
  noteMissingOdometry(cloud, transforms.odometry_error);
  run_.time_field = checked.time_field;
  StageTimer timer(Clock::kProcessCpu);
  const PipelineResult result = pipeline_.process(checked.view, transforms.prior());
  if (!result.too_large.empty()) {
    return leaveOut(cloud, toString(CloudFault::kTooLarge), result.too_large);
  }
  noteOdometryJump(cloud, result.scan);
  noteBegunAnew(cloud, result.scan);
  noteNotLocated(cloud, result.scan);
  run_.add(cloud, result, transforms.T_base_sensor, timer.lap());
}

void CloudMapping::noteMissingOdometry(size_t cloud, const std::string& error) {
  if (error.empty() || ++run_.without_odometry > 1) return;
  console_.print("cloud " + std::to_string(cloud) + " is predicted at constant velocity: " + error +
                 ". More of this kind are counted only.");
}

void CloudMapping::noteOdometryJump(size_t cloud, const ScanResult& scan) {
  if (!scan.odometry_jumped || run_.odometry_jumps > 0) return;
  console_.print("cloud " + std::to_string(cloud) + " is predicted at constant velocity: " +
                 odometryJumpText() + ". More of this kind are counted only.");
}

void CloudMapping::noteBegunAnew(size_t cloud, const ScanResult& scan) {
  if (!scan.begun_anew || run_.begun_anew > 0) return;
  console_.print("cloud " + std::to_string(cloud) + ": " + begunAnewText() +
                 " More of this kind are counted only.");
}

void CloudMapping::noteNotLocated(size_t cloud, const ScanResult& scan) {
  if (scan.located()) return;
  const auto [advice, is_first] =
      advice_.try_emplace(scan.status, edgevox::adviceOn(scan, kWayOut));
  if (!is_first) return;
  console_.print("cloud " + std::to_string(cloud) + " is " + toString(scan.status) + ": " +
                 advice->second + ". More of this kind are counted only.");
}

std::string CloudMapping::adviceOn(ScanStatus status) const {
  const auto found = advice_.find(status);
  return found == advice_.end() ? "" : found->second;
}

void CloudMapping::printNote(const std::string& note) {
  if (note.empty() || note == printed_note_) return;
  console_.print(note);
  printed_note_ = note;
}

}  // namespace edgevox
