// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/mapper_node.hpp"

#include <functional>
#include <iostream>
#include <optional>
#include <utility>

#include "edgevox/io/atomic_file.hpp"
#include "nodes/load_map.hpp"
#include "nodes/save_run.hpp"
#include "nodes/scan_report.hpp"
#include "ros/conversions/voxel_scan_message.hpp"

namespace edgevox {

MapperNode::MapperNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                       const std::string& name)
    : log_(name),
      parameters_(readMapperParameters(private_handle)),
      map_publisher_(handle, parameters_.map_frame),
      mapper_(parameters_.config, Clock::kWall),
      io_(handle, parameters_, log_,
          [this](const VoxelScanStamped& scan, const ScanTransforms& transforms) {
            return map(scan, transforms);
          }),
      map_timer_(handle.createWallTimer(ros::WallDuration(parameters_.map_period),
                                        [this](const ros::WallTimerEvent&) { publishMap(); })),
      diagnostics_(handle, private_handle, name,
                   [this](DiagnosticStatus& status) { diagnose(status); }) {
  mapper_ = newMapper();
  io_.services().add("save_map", &MapperNode::saveMap, this);
  io_.services().add("load_map", &MapperNode::loadMap, this);
  io_.services().add("reset", &MapperNode::reset, this);
  std::function<void()> load;
  if (parameters_.map) load = [this] { loadGivenMap(); };
  io_.start(std::move(load));
}

MapperNode::~MapperNode() {
  io_.end();
  saveAtTheEnd();
}

/// What nobody has saved since the map last changed. The log does not go out any more.
void MapperNode::saveAtTheEnd() {
  if (map_version_ == saved_version_ || run_.located() == 0) return;
  std::string text;
  try {
    text = parameters_.output.empty()
               ? "the map of " + std::to_string(run_.located()) +
                     " scans is not saved: output is not set, and save_map was not called"
               : saveRun(parameters_.output, parameters_.config, record(), parameters_.map_frame,
                         false, mapper_);
  } catch (const std::exception& error) {
    text = error.what();
  }
  std::cerr << "edgevox: " << text << std::endl;
}

/// With what was left out.
RunRecord MapperNode::record() const {
  RunRecord run = run_;
  const TrackingIo::Counts counts = io_.counts();
  run.left_out = counts.left_out;
  run.refused = counts.refused;
  run.dropped = counts.dropped;
  return run;
}

/// In the thread of the scans.
void MapperNode::loadGivenMap() {
  try {
    Mapper mapper = newMapper();
    parameters_.map->restore(mapper);
    const std::lock_guard<std::mutex> lock(mutex_);
    put(std::move(mapper));
  } catch (const std::exception& error) {
    const std::lock_guard<std::mutex> lock(mutex_);
    map_error_ = error.what();
    ROS_ERROR_STREAM(map_error_);
  }
  parameters_.map.reset();
}

Mapper MapperNode::newMapper() const {
  Mapper mapper(parameters_.config, Clock::kWall);
  mapper.setControl({kAllProcessors, &io_.interrupted()});
  return mapper;
}

/// In place of the mapper there is; its mutex must be held.
void MapperNode::put(Mapper mapper) {
  mapper_ = std::move(mapper);
  run_ = {};
  map_error_.clear();
  ++map_version_;
  ++map_start_;
}

ScanReport MapperNode::map(const VoxelScanStamped& scan, const ScanTransforms& transforms) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!map_error_.empty()) return reportOn(scan, noMap(map_error_));
  const VoxelScan voxels = voxelsToMatch(fromMessage(scan), parameters_.config.mapper.scan_voxels);
  if (const auto pose = io_.takePose(transforms)) mapper_.lookNear(*pose);
  ScanResult result = mapper_.track(voxels, transforms.prior());
  if (result.clock_jumped) clockJumped();
  if (result.begun_anew) begunAnew(scan.number);
  if (!transforms.odometry_error.empty()) ++run_.without_odometry;
  const float latency = io_.publishPose(scan, result, transforms);
  if (result.located()) {
    mapper_.insert(voxels, result);
    ++map_version_;
    io_.publishScanEdges(mapper_.recentEdges());
  }
  if (mapper_.map().isFull()) log_.warn("map_full", fullText(parameters_.config.map));
  ScanReport report = reportOn(scan, result, "call reset for a new map");
  report.latency = latency;
  const auto total = static_cast<double>(timesOf(report).total());
  run_.time_field = scan.time_field;
  run_.add(scan.number, toPipelineResult(scan, result), transforms.T_base_sensor, total,
           static_cast<double>(report.latency));
  return report;
}

void MapperNode::clockJumped() {
  const bool cleared = parameters_.config.mapper.after_clock_jump == AfterClockJump::kClearMap;
  if (cleared) io_.forgetPoses();
  ++map_version_;
  ++map_start_;
  log_.warn("clock_jump",
            "the stamps have jumped back: the velocity is forgotten, and the map is " +
                std::string(cleared ? "cleared" : "kept; call reset for a new one"));
}

void MapperNode::begunAnew(uint64_t scan) {
  io_.forgetPoses();
  ++map_version_;
  ++map_start_;
  log_.warn("begun_anew", "scan " + std::to_string(scan) + ": " + begunAnewText());
}

void MapperNode::publishMap() {
  const std::lock_guard<std::mutex> publishing(publishing_);
  io_.publishPath();
  std::optional<MapSnapshot> snapshot;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (map_publisher_.isDue(map_version_)) {
      snapshot = snapshotOf(mapper_.map());
      snapshot->version = map_version_;
      snapshot->start = map_start_;
      snapshot->stamp = io_.lastStamp();
    }
  }
  if (snapshot) map_publisher_.publish(*snapshot);
}

bool MapperNode::saveMap(SaveMap::Request& request, SaveMap::Response& response) {
  const std::string folder = request.folder.empty() ? parameters_.output : request.folder;
  std::unique_lock<std::mutex> lock(mutex_);
  Mapper mapper = mapper_;
  const RunRecord run = record();
  const std::string map_error = map_error_;
  const uint64_t version = map_version_;
  lock.unlock();
  return answer(response, log_, [&] {
    if (!map_error.empty()) throw FileError("nothing is saved, as there is no map: " + map_error);
    std::string saved =
        saveRun(folder, parameters_.config, run, parameters_.map_frame, request.full != 0, mapper);
    lock.lock();
    saved_version_ = version;
    return saved;
  });
}

bool MapperNode::loadMap(LoadMap::Request& request, LoadMap::Response& response) {
  return answer(response, log_, [&] {
    const MapFile file = readMapFile(request.file, parameters_);
    Mapper mapper = newMapper();
    file.restore(mapper);
    io_.interrupt();
    const std::lock_guard<std::mutex> lock(mutex_);
    put(std::move(mapper));
    io_.reset();
    return loadedText(request.file, file) + "; mapping goes on where the sensor is found in it";
  });
}

bool MapperNode::reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  io_.interrupt();
  const std::lock_guard<std::mutex> lock(mutex_);
  put(newMapper());
  io_.reset();
  response.message = "the map is empty; the next scan is its first";
  response.success = static_cast<uint8_t>(true);
  return true;
}

void MapperNode::diagnose(DiagnosticStatus& status) {
  std::unique_lock<std::mutex> lock(mutex_);
  const MapBuilder map = mapper_.map();
  const std::string map_error = map_error_;
  lock.unlock();
  io_.fill(status);
  if (!map_error.empty()) status.mergeSummary(DiagnosticStatus::ERROR, map_error);
  if (map.isFull()) warn(fullText(parameters_.config.map), status);
  status.add("edge voxels of the map", map.edgeVoxels().voxelCount());
  status.add("occupied voxels of the map", map.hitVoxelCount());
  status.addf("map in memory [MB]", "%.2f", static_cast<double>(map.bytes()) / 1e6);
  status.add("frozen voxels of the map", map.frozenVoxels());
  status.add("frozen regions of the map", map.frozenRegions());
  status.add("centroids alone, left out", map.loneCentroids());
  status.add("centroids past map/memory, left out", map.centroidsPastMemory());
}

}  // namespace edgevox
