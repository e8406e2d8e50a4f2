// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/paper_method.hpp"

#include <limits>
#include <utility>

#include "core/scan/scan_sample.hpp"
#include "edgevox/map/map_builder.hpp"
#include "edgevox/matching/matcher.hpp"
#include "edgevox/tracking/tracker.hpp"
#include "evaluation/octree_leaves.hpp"
#include "evaluation/placed_scan.hpp"
#include "tools/config_file.hpp"

namespace edgevox {
namespace {

MapBuilder builderFor(const Config& config) {
  return {config.voxel_size, config.map, config.edges, config.threads, config.voxelizer.max_range};
}

/// The preset paper, but with all points of a scan and all voxels of a map.
Config publishedConfig(double voxel_size) {
  Config config;
  applyConfigFile(findConfigFile("paper"), config);
  config.voxel_size = voxel_size;
  config.map.coarsest_voxel = 32 * voxel_size;
  config.map.memory = std::numeric_limits<int>::max();
  config.matcher.search_points = std::numeric_limits<int>::max();
  return config;
}

/// The centres of the leaves that pcl::octree has for the points, in place of the voxels.
VoxelScan leavesOf(const VoxelScan& scan) {
  std::vector<Eigen::Vector3f> points;
  for (const ScanVoxel& voxel : scan.voxels) points.push_back(voxel.centroid);
  VoxelScan leaves = scan;
  leaves.voxel_size = 2 * scan.voxel_size;
  leaves.voxels.clear();
  for (const Eigen::Vector3f& centre : octreeLeafCentres(points, leaves.voxel_size)) {
    ScanVoxel leaf;
    leaf.index = voxelAt(centre.cast<double>(), 1.0 / leaves.voxel_size);
    leaf.centroid = centre;
    leaf.point_count = 1;
    leaves.voxels.push_back(leaf);
  }
  return leaves;
}

/// Every pose is taken for right, as published.
class PublishedMethod final : public PaperMethod {
 public:
  explicit PublishedMethod(const Config& config)
      : matcher_(config.matcher), map_(builderFor(config)) {}

  PaperPose align(const PaperScan& scan, const Pose& guess) override {
    MatchRequest request;
    request.guess.T_map_sensor = guess;
    const ScanSample sample = sampleCentroids(scan.voxels, scan.voxels.voxels.size());
    return {matcher_.align(map_.matchMap(), sample, request).T_map_sensor, true};
  }
  void insert(const PaperScan& scan, const Pose& T_map_sensor) override {
    map_.add(placedCentroids(scan.voxels, standingAt(T_map_sensor)), T_map_sensor.translation());
  }

 private:
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
    map_.insert(placedCentroids(scan.scan, standingAt(T_map_sensor)), T_map_sensor.translation());
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

VoxelScan chosenVoxels(const VoxelScan& scan, PaperVoxels voxels) {
  switch (voxels) {
    case PaperVoxels::kAll:
      return inMapVoxels(scan);
    case PaperVoxels::kEdges:
      return edgeVoxels(scan);
    case PaperVoxels::kOctreeLeaves:
      return leavesOf(scan);
  }
  return {};
}

std::unique_ptr<PaperMethod> makePublished(double voxel_size) {
  return std::make_unique<PublishedMethod>(publishedConfig(voxel_size));
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
    add(name, voxels, makeIcp);
  }
  const double size = config.voxel_size;
  for (const auto& [name, voxels] : {std::pair("MROL on all voxels", PaperVoxels::kAll),
                                     std::pair("MROL on edge voxels", PaperVoxels::kEdges)}) {
    add(name, voxels, [size] { return makePublished(size); });
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
