// SPDX-License-Identifier: BSD-3-Clause
// Stages whose time is bounded in milliseconds: a cloud of 100,000 points, and the same scans on
// maps of very different sizes.
#include <algorithm>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

#include "benchmarks.hpp"
#include "edgevox/edges/edge_extractor.hpp"
#include "edgevox/map/map_builder.hpp"
#include "sequence.hpp"
#include "sim/scanner.hpp"
#include "sim/worlds.hpp"
#include "street_tile.hpp"

namespace edgevox::bench {
namespace {

using benchmark::State;

constexpr size_t kPoints = 100000;
constexpr double kVoxelSize = 0.1;  // of the map [m]
constexpr int kFirstSweep = 15;     // the sensor moves from here on
constexpr int kSweepStep = 5;       // a scan every half second
constexpr int kWalkScans = 20;      // the first half is added before time is taken

/// A cloud of 64 rings in the simulated building, cut to kPoints.
const Cloud& bigCloud() {
  static const Cloud cloud = [] {
    const sim::Sensor sensor = sim::makeSensor("64");
    const sim::World world = sim::makeWorld(sim::WorldName::Building, 1);
    const sim::Trajectory path = sim::makeTrajectory(sim::WorldName::Building, sensor);
    Cloud made = recordedScan(sim::simulateSweep(world, path, sensor, kFirstSweep, 1));
    if (made.view.width < kPoints) throw std::runtime_error("the cloud has too few points");
    made.view.width = kPoints;
    return made;
  }();
  return cloud;
}

void voxelizeBig(State& state) {
  Voxelizer voxelizer({}, kVoxelSize);
  size_t voxels = 0;
  for (auto _ : state) voxels = voxelizer.voxelize(bigCloud().view).voxels.size();
  state.counters["voxels"] = static_cast<double>(voxels);
}

void extractBig(State& state, double voxel_size) {
  VoxelScan scan = Voxelizer({}, voxel_size).voxelize(bigCloud().view);
  EdgeExtractor extractor({}, 1);
  EdgeCount count;
  for (auto _ : state) count = extractor.extract(scan);
  state.counters["voxels"] = static_cast<double>(count.occupied);
}

/// One scan of a walk, in the map frame [m].
struct PlacedScan {
  std::vector<Eigen::Vector3d> centroids;
  Eigen::Vector3d sensor;
};

/// Through the simulated building, placed by the true poses.
const std::vector<PlacedScan>& walk() {
  static const std::vector<PlacedScan> scans = [] {
    const sim::Sensor sensor = sim::makeSensor("64");
    const sim::World world = sim::makeWorld(sim::WorldName::Building, 1);
    const sim::Trajectory path = sim::makeTrajectory(sim::WorldName::Building, sensor);
    Voxelizer voxelizer({}, kVoxelSize);
    std::vector<PlacedScan> placed(kWalkScans);
    for (int i = 0; i < kWalkScans; ++i) {
      const auto sweep = sim::simulateSweep(world, path, sensor, kFirstSweep + i * kSweepStep, 1);
      PlacedScan& scan = placed[static_cast<size_t>(i)];
      scan.sensor = path.poseAt(sweep.stamp).translation();
      for (const ScanVoxel& v : voxelizer.voxelize(recordedScan(sweep).view).voxels) {
        const Pose T_world_then = path.poseAt(sweep.stamp + static_cast<double>(v.time_offset));
        scan.centroids.push_back(T_world_then * v.centroid.cast<double>());
      }
    }
    return placed;
  }();
  return scans;
}

/// A street of `voxels` labelled voxels, beside the building.
const MapBuilder& street(size_t voxels) {
  static std::map<size_t, MapBuilder> made;
  const auto known = made.find(voxels);
  if (known != made.end()) return known->second;
  MapBuilder map(kVoxelSize, {}, {}, 1);
  for (int tile = 0; map.hitVoxelCount() < voxels; ++tile) {
    std::vector<Eigen::Vector3d> centres = streetTile(tile, kVoxelSize);
    centres.resize(std::min(centres.size(), voxels - map.hitVoxelCount()));
    for (int hit = 0; hit < MapConfig{}.min_hits; ++hit) {
      map.add(centres, streetSensor(tile, kVoxelSize));
    }
    map.label();
  }
  return made.emplace(voxels, std::move(map)).first->second;
}

/// Times `step` for the second half of the walk; before each, not timed, `before`.
template <typename Before, typename Step>
void timeOnStreet(State& state, size_t voxels, const Before& before, const Step& step) {
  const MapBuilder& base = street(voxels);
  size_t changed = 0;
  while (state.KeepRunningBatch(kWalkScans / 2)) {
    state.PauseTiming();
    MapBuilder map = base;
    for (size_t i = 0; i < kWalkScans; ++i) {
      const size_t known = map.hitVoxelCount();
      const bool timed = i >= kWalkScans / 2;
      before(map, walk()[i]);
      if (timed) state.ResumeTiming();
      step(map, walk()[i]);
      if (timed) state.PauseTiming();
      if (timed) changed += map.hitVoxelCount() - known;
    }
    state.counters["map_MB"] = static_cast<double>(map.bytes()) * 1e-6;
    { const MapBuilder freed = std::move(map); }
    state.ResumeTiming();
  }
  state.counters["new_voxels"] =
      static_cast<double>(changed) / static_cast<double>(state.iterations());
}

void addScan(MapBuilder& map, const PlacedScan& scan) { map.add(scan.centroids, scan.sensor); }

void updateLabels(MapBuilder& map, const PlacedScan&) { map.label(); }

void registerOnStreet(const std::string& suffix, size_t voxels) {
  add("label", suffix, [=](State& state, const std::string&) {
    timeOnStreet(state, voxels, addScan, updateLabels);
  })->Iterations(kWalkScans / 2);
  add("insert", suffix, [=](State& state, const std::string&) {
    timeOnStreet(state, voxels, updateLabels, addScan);
  })->Iterations(kWalkScans / 2);
  add("insert_after_snapshot", suffix, [=](State& state, const std::string&) {
    std::unique_ptr<MapBuilder> snapshot;
    const auto take = [&](MapBuilder& map, const PlacedScan& scan) {
      updateLabels(map, scan);
      snapshot = std::make_unique<MapBuilder>(map);
    };
    timeOnStreet(state, voxels, take, addScan);
  })->Iterations(kWalkScans / 2);
  add("snapshot", suffix, [=](State& state, const std::string&) {
    std::unique_ptr<MapBuilder> snapshot;
    const auto take = [&](MapBuilder& map, const PlacedScan&) {
      snapshot = std::make_unique<MapBuilder>(map);
    };
    const auto insert = [&](MapBuilder& map, const PlacedScan& scan) {
      snapshot.reset();
      addScan(map, scan);
      updateLabels(map, scan);
    };
    timeOnStreet(state, voxels, insert, take);
  })->Iterations(kWalkScans / 2);
}

}  // namespace

void addLimitBenchmarks() {
  add("voxelize", "100k_points", [](State& state, const std::string&) { voxelizeBig(state); });
  add("extract", "100k_points_10cm",
      [](State& state, const std::string&) { extractBig(state, 0.10); });
  add("extract", "100k_points_5cm",
      [](State& state, const std::string&) { extractBig(state, 0.05); });
  registerOnStreet("map_100k", 100000);
  registerOnStreet("map_1M", 1000000);
  registerOnStreet("map_10M", 10000000);
}

}  // namespace edgevox::bench
