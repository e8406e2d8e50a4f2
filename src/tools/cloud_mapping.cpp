// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cloud_mapping.hpp"

#include "edgevox/stage_timer.hpp"

namespace edgevox {

CloudMapping::CloudMapping(const Config& config, const SensorFrames& frames, Console& console)
    : frames_(frames), console_(console), pipeline_(config) {}

void CloudMapping::add(size_t cloud, const sensor_msgs::PointCloud2::ConstPtr& message) {
  if (!message) {
    return leaveOut(cloud, "undecodable",
                    "it cannot be decoded: the bag is damaged or holds another version of "
                    "sensor_msgs/PointCloud2, see 'rosbag check'");
  }
  const CloudReading reading = readCloud(*message);
  if (const auto* error = std::get_if<CloudError>(&reading)) {
    return leaveOut(cloud, name(error->fault), error->text);
  }
  const std::string& frame = message->header.frame_id;
  if (!scans_.empty() && frame != frame_) {
    return leaveOut(cloud, "other_frame",
                    "its frame is '" + frame + "', that of the first scan is '" + frame_ +
                        "'; one sensor can be mapped, give its clouds a topic of their own");
  }
  process(cloud, *message, std::get<CheckedCloud>(reading));
}

void CloudMapping::leaveOut(size_t cloud, const std::string& reason, const std::string& text) {
  if (++left_out_[reason] > 1) return;
  console_.print("cloud " + std::to_string(cloud) + " is left out: " + text +
                 ". More of this kind are counted only.");
}

void CloudMapping::process(size_t cloud, const sensor_msgs::PointCloud2& message,
                           const CheckedCloud& checked) {
  const std_msgs::Header& header = message.header;
  const Transform mounting = frames_.mounting(header.frame_id, header.stamp);
  if (const auto* error = std::get_if<TransformError>(&mounting)) {
    return leaveOut(cloud, "no_mounting", error->text);
  }
  printNote(checked.note);
  time_field_ = checked.time_field;
  frame_ = header.frame_id;
  const std::optional<Pose> T_odom_sensor = odometryOf(cloud, header);

  StageTimer timer(Clock::kProcessCpu);
  ScanRecord record;
  record.cloud = cloud;
  record.result = pipeline_.process(checked.view, {T_odom_sensor, Pose::Identity()});
  record.total = timer.lap();
  record.T_map_body = record.result.scan.T_map_sensor * std::get<Pose>(mounting).inverse();
  scans_.push_back(record);
}

std::optional<Pose> CloudMapping::odometryOf(size_t cloud, const std_msgs::Header& header) {
  if (!frames_.usesOdometry()) return std::nullopt;
  const Transform odometry = frames_.odometry(header.frame_id, header.stamp);
  if (const auto* pose = std::get_if<Pose>(&odometry)) return *pose;
  if (++without_odometry_ == 1) {
    console_.print("cloud " + std::to_string(cloud) + " is predicted at constant velocity: " +
                   std::get<TransformError>(odometry).text +
                   ". More of this kind are counted only.");
  }
  return std::nullopt;
}

void CloudMapping::printNote(const std::string& note) {
  if (note.empty() || note == printed_note_) return;
  console_.print(note);
  printed_note_ = note;
}

Trajectory CloudMapping::trajectory() const {
  Trajectory trajectory;
  for (const ScanRecord& record : scans_) {
    if (!record.result.scan.located()) continue;
    trajectory.push_back({record.result.scan.stamp, record.T_map_body});
  }
  return trajectory;
}

}  // namespace edgevox
