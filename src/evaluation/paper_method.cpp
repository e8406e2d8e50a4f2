// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/paper_method.hpp"

#include <limits>
#include <utility>

#include "core/scan/scan_sample.hpp"
#include "edgevox/map/map_builder.hpp"
#include "edgevox/matching/matcher.hpp"
#include "edgevox/tracking/tracker.hpp"

namespace edgevox {
namespace {

std::vector<Eigen::Vector3d> placed(const VoxelScan& scan, const Pose& T_map_sensor) {
  std::vector<Eigen::Vector3d> centroids;
  centroids.reserve(scan.voxels.size());
  for (const ScanVoxel& voxel : scan.voxels) {
    centroids.push_back(T_map_sensor * voxel.centroid.cast<double>());
  }
  return centroids;
}

MapBuilder builderFor(const Config& config) {
  return {config.voxel_size, config.map, config.edges, config.threads, config.voxelizer.max_range};
}

Config publishedConfig(double voxel_size) {
  Config config;
  config.voxel_size = voxel_size;
  config.edges.mode = EdgeMode::kPaper;
  config.map.representation = Representation::kAll;
  config.map.coarsest_voxel = 32 * voxel_size;
  config.map.min_hits = 1;
  config.map.confirm_within = 0;
  config.map.freeze_after = 0;
  config.map.memory = std::numeric_limits<int>::max();
  config.matcher.mode = MatcherMode::kPublished;
  config.matcher.search_points = std::numeric_limits<int>::max();
  config.matcher.refine_points = 50;  // are verified, which nobody asks for
  return config;
}

/// Every pose is taken for right, as published.
class PublishedMethod final : public PaperMethod {
 public:
  PublishedMethod(double voxel_size, PaperVoxels voxels)
      : config_(publishedConfig(voxel_size)),
        voxels_(voxels),
        matcher_(config_.matcher),
        map_(builderFor(config_)) {}

  PaperPose align(const PaperScan& scan, const Pose& guess) override {
    const VoxelScan voxels = chosenVoxels(scan, voxels_);
    MatchRequest request;
    request.guess.T_map_sensor = guess;
    const ScanSample sample = sampleCentroids(voxels, voxels.voxels.size());
    return {matcher_.align(map_.matchMap(), sample, request).T_map_sensor, true};
  }
  void insert(const PaperScan& scan, const Pose& T_map_sensor) override {
    map_.add(placed(chosenVoxels(scan, voxels_), T_map_sensor), T_map_sensor.translation());
  }

 private:
  Config config_;
  PaperVoxels voxels_;
  Matcher matcher_;
  MapBuilder map_;
};

class TrackerMethod final : public PaperMethod {
 public:
  explicit TrackerMethod(const Config& config) : tracker_(config), map_(builderFor(config)) {}

  PaperPose align(const PaperScan& scan, const Pose& guess) override {
    tracker_.setPose(guess);
    const ScanResult result = tracker_.track(
        scan.scan, {}, {map_.matchMap(), false, map_.scans(), [this] { map_.prepareAll(); }});
    return {result.T_map_sensor, result.located()};
  }
  void insert(const PaperScan& scan, const Pose& T_map_sensor) override {
    map_.insert(placed(scan.scan, T_map_sensor), T_map_sensor.translation());
  }

 private:
  Tracker tracker_;
  MapBuilder map_;
};

Config withRepresentation(Config config, Representation representation) {
  config.map.representation = representation;
  return config;
}

}  // namespace

std::unique_ptr<PaperMethod> makePublished(double voxel_size, PaperVoxels voxels) {
  return std::make_unique<PublishedMethod>(voxel_size, voxels);
}

std::unique_ptr<PaperMethod> makeTracker(const Config& config) {
  return std::make_unique<TrackerMethod>(config);
}

std::vector<NamedPaperMethod> paperMethods(const Config& config) {
  std::vector<NamedPaperMethod> methods;
  const auto add = [&](const char* name, PaperVoxels voxels, auto make) {
    methods.push_back({name, voxels, std::move(make)});
  };
  for (const auto& [name, voxels] :
       {std::pair("ICP on all voxels", PaperVoxels::kAll),
        std::pair("ICP on edge voxels", PaperVoxels::kEdges),
        std::pair("ICP on octree leaves", PaperVoxels::kOctreeLeaves)}) {
    add(name, voxels, [voxels = voxels] { return makeIcp(voxels); });
  }
  const double size = config.voxel_size;
  for (const auto& [name, voxels] : {std::pair("MROL on all voxels", PaperVoxels::kAll),
                                     std::pair("MROL on edge voxels", PaperVoxels::kEdges)}) {
    add(name, voxels, [=, voxels = voxels] { return makePublished(size, voxels); });
  }
  for (const auto& [name, representation] : {std::pair("edgevox edges", Representation::kEdges),
                                             std::pair("edgevox sparse", Representation::kSparse),
                                             std::pair("edgevox all", Representation::kAll)}) {
    const Config with = withRepresentation(config, representation);
    add(name, PaperVoxels::kAll, [with] { return makeTracker(with); });
  }
  return methods;
}

}  // namespace edgevox
