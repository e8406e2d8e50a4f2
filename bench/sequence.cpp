// SPDX-License-Identifier: BSD-3-Clause
#include "sequence.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <utility>
#include <variant>

#include "edgevox/mapping/pipeline.hpp"
#include "edgevox/scan/motion.hpp"
#include "ros/conversions/point_cloud.hpp"
#include "sim/scanner.hpp"
#include "sim/worlds.hpp"
#include "tools/bag_reader.hpp"

namespace edgevox::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kScans = 20;

struct Source {
  const char* name;
  double voxel_size;      // [m]
  double coarsest_voxel;  // [m]
  size_t first;           // the sensor moves from here on
  const char* sensor;     // of a simulated world; null for a bag
  sim::WorldName world;
};
constexpr Source kSources[] = {
    {"building", 0.2, 6.4, 15, "32", sim::WorldName::Building},
    {"street", 0.4, 12.8, 15, "64", sim::WorldName::Street},
    {"handheld_a", 0.1, 3.2, 18, nullptr, {}},
    {"street_a", 0.4, 12.8, 1, nullptr, {}},
};

fs::path bagOf(const Source& source) {
  const char* folder = std::getenv("EDGEVOX_DATA");
  return fs::path(folder != nullptr ? folder : EDGEVOX_DEFAULT_DATA) /
         (std::string(source.name) + ".bag");
}

std::vector<Cloud> simulate(const Source& source) {
  const sim::Sensor sensor = sim::makeSensor(source.sensor);
  const sim::World world = sim::makeWorld(source.world, 1);
  const sim::Trajectory path = sim::makeTrajectory(source.world, sensor);
  std::vector<Cloud> clouds;
  const auto first = static_cast<int>(source.first);
  for (const auto& scan : sim::simulateSweeps(world, path, sensor, first, kScans, 1, 2)) {
    clouds.push_back(recordedScan(scan));
  }
  return clouds;
}

Cloud cloudOf(const sensor_msgs::PointCloud2& message) {
  Cloud cloud;
  cloud.bytes = message.data;
  const auto reading = readCloud(message, VoxelizerConfig());
  if (const auto* error = std::get_if<CloudError>(&reading)) throw std::runtime_error(error->text);
  cloud.view = std::get<CheckedCloud>(reading).view;
  cloud.view.data = cloud.bytes.data();
  return cloud;
}

std::vector<Cloud> readBag(const Source& source) {
  std::vector<Cloud> clouds;
  BagReader reader(bagOf(source).string(), "");
  reader.forEachCloud([&](size_t i, const BagReader::ReadCloud& read) {
    if (i < source.first || i >= source.first + kScans) return;
    const BagCloud cloud = read();
    if (cloud.message) clouds.push_back(cloudOf(*cloud.message));
  });
  return clouds;
}

void track(Sequence& sequence) {
  Voxelizer voxelizer(sequence.config.voxelizer, sequence.config.voxel_size);
  Mapper mapper(sequence.config);
  for (const Cloud& cloud : sequence.clouds) {
    const VoxelScan& scan = sequence.scans.emplace_back(voxelizer.voxelize(cloud.view));
    const ScanResult result = mapper.process(scan);
    if (!result.located()) throw std::runtime_error("a scan was not matched: " + scan.frame);
    sequence.poses.push_back(result.T_map_sensor);
  }
}

Twist twistAt(const Sequence& sequence, size_t i) {
  if (i == 0) return {};
  return twistOf(sequence.poses[i - 1].inverse() * sequence.poses[i],
                 sequence.scans[i].stamp - sequence.scans[i - 1].stamp);
}

void placeInMap(Sequence& sequence) {
  for (size_t i = 0; i < sequence.size(); ++i) {
    const Twist twist = twistAt(sequence, i);
    auto& centroids = sequence.centroids.emplace_back();
    for (const ScanVoxel& voxel : sequence.scans[i].voxels) {
      const Pose T_map_then =
          sequence.poses[i] * moved(twist, static_cast<double>(voxel.time_offset));
      centroids.push_back(T_map_then * voxel.centroid.cast<double>());
    }
  }
}

Sequence make(const Source& source) {
  Sequence sequence;
  sequence.config.voxel_size = source.voxel_size;
  sequence.config.map.coarsest_voxel = source.coarsest_voxel;
  sequence.clouds = source.sensor != nullptr ? simulate(source) : readBag(source);
  if (sequence.size() < kScans) {
    throw std::runtime_error(std::string(source.name) + " has fewer than " +
                             std::to_string(source.first + kScans) + " clouds");
  }
  track(sequence);
  placeInMap(sequence);
  return sequence;
}

}  // namespace

std::vector<std::string> sequenceNames() {
  std::vector<std::string> names;
  for (const Source& source : kSources) {
    if (source.sensor != nullptr || fs::exists(bagOf(source))) names.emplace_back(source.name);
  }
  return names;
}

const Sequence& sequence(const std::string& name) {
  static std::map<std::string, Sequence> made;
  const auto known = made.find(name);
  if (known != made.end()) return known->second;
  const auto* source = std::find_if(std::begin(kSources), std::end(kSources),
                                    [&](const Source& s) { return s.name == name; });
  if (source == std::end(kSources)) throw std::runtime_error("no sequence is called " + name);
  return made.emplace(name, make(*source)).first->second;
}

}  // namespace edgevox::bench
