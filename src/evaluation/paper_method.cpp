// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/paper_method.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/scan/scan_sample.hpp"
#include "edgevox/map/map_builder.hpp"
#include "edgevox/matching/matcher.hpp"
#include "evaluation/octree_leaves.hpp"
#include "evaluation/placed_scan.hpp"
#include "tools/config_file.hpp"

namespace edgevox {
namespace {

constexpr double kBeyondDoubt = 0.9;     // hit ratio, from which on no other place is looked at
constexpr double kMostBlocked = 0.2;     // lines of sight
constexpr double kFarthest = 6.0;        // from the guess, of the deviation on one axis
constexpr double kLeastDistance = 0.01;  // of the guess [m]
constexpr double kLeastAngle = 0.1;      // of the guess [degrees]
constexpr double kDegree = M_PI / 180.0;

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
    return {matcher_.align(map_.matchMap(), sample, request).T_map_sensor, true, {}};
  }
  void insert(const PaperScan& scan, const Pose& T_map_sensor) override {
    map_.add(placedCentroids(scan.voxels, standingAt(T_map_sensor)), T_map_sensor.translation());
  }

 private:
  Matcher matcher_;
  MapBuilder map_;
};

Matrix6 covarianceOf(const GuessError& error) {
  const double angle = error.angle * kDegree;
  Vector6 variances;
  variances << Eigen::Vector3d::Constant(error.distance * error.distance),
      Eigen::Vector3d::Constant(angle * angle);
  return variances.asDiagonal();
}

/// The matcher of edgevox, told how poor the guess is: unless nearly all fits, it looks at other
/// places, too. What is too young to be selected is matched to all voxels, as by the tracker.
class EdgevoxMethod final : public PaperMethod {
 public:
  EdgevoxMethod(const Config& config, const GuessError& error)
      : config_(config),
        error_{std::max(error.distance, kLeastDistance), std::max(error.angle, kLeastAngle)},
        matcher_(config.matcher),
        map_(builderFor(config)) {}

  PaperPose align(const PaperScan& scan, const Pose& guess) override {
    ScanSample sample;
    for (const size_t i : sampleVoxels(scan.scan, matcher_.sampleSize())) {
      sample.push_back(scan.scan.voxels[i].centroid.cast<double>());
    }
    MatchRequest request;
    request.guess = Prediction::withCovariance(guess, covarianceOf(error_), false);
    request.max_translation = kFarthest * error_.distance;
    request.max_rotation = kFarthest * error_.angle * kDegree;
    request.doubtful = true;
    request.trusted_hit_ratio = kBeyondDoubt;
    request.required_hit_ratio = request.far_hit_ratio = config_.matcher.min_hit_ratio;
    request.most_blocked = request.most_blocked_near = kMostBlocked;
    request.seed = map_.scans();
    MatchResult result = matcher_.match(map_.matchMap(), sample, request);
    if (!result.accepted() || result.matches < config_.mapper.fallback_matches) {
      map_.prepareAll();
      request.all_voxels = true;
      result = matcher_.match(map_.matchMap(), sample, request);
    }
    return {result.T_map_sensor, result.accepted(), result.refusal};
  }
  void insert(const PaperScan& scan, const Pose& T_map_sensor) override {
    map_.insert(placedCentroids(scan.scan, standingAt(T_map_sensor)), T_map_sensor.translation());
  }

 private:
  Config config_;
  GuessError error_;
  Matcher matcher_;
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

std::unique_ptr<PaperMethod> makeEdgevox(const Config& config, const GuessError& error) {
  return std::make_unique<EdgevoxMethod>(config, error);
}

std::vector<NamedPaperMethod> paperMethods(const Config& config, const GuessError& error) {
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
    add(name, PaperVoxels::kAll, [with, error] { return makeEdgevox(with, error); });
  }
  return methods;
}

}  // namespace edgevox
