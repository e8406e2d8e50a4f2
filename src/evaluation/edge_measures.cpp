// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/edge_measures.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "edgevox/edges/edge_extractor.hpp"
#include "edgevox/edges/recent_edges.hpp"
#include "edgevox/map/map_builder.hpp"
#include "edgevox/ring_buffer.hpp"
#include "edgevox/stage_timer.hpp"
#include "evaluation/cloud_points.hpp"
#include "evaluation/edge_detectors.hpp"
#include "evaluation/edge_truth.hpp"
#include "evaluation/ghosts.hpp"
#include "evaluation/labelled_voxels.hpp"
#include "evaluation/octree_leaves.hpp"
#include "evaluation/share.hpp"

namespace edgevox {
namespace {

constexpr double kMapLevels = 8.0;     // coarsest voxel of the map / finest; labels need one level
constexpr size_t kJudgedInScan = 20;   // false edges, at most
constexpr size_t kJudgedInMap = 1000;  // the same

constexpr double kGridYaw = 0.44;  // rad, 25 degrees

struct Method {
  const char* name;
  EdgeMode mode;
  bool support;
};
constexpr Method kMethods[] = {
    {"scan as published", EdgeMode::kPaper, false},
    {"scan without support", EdgeMode::kDefault, false},
    {"scan with support", EdgeMode::kDefault, true},
};

EdgeConfig configOf(const Method& method, EdgeConfig config) {
  config.mode = method.mode;
  if (!method.support) config.scan.support = 0.0;
  return config;
}

/// Occupied voxels over what is left of them.
class Compression {
 public:
  void add(size_t occupied, size_t kept) {
    ++scans_;
    occupied_ += static_cast<double>(occupied);
    kept_ += static_cast<double>(kept);
    if (kept == 0) return;
    ++ratios_;
    sum_of_ratios_ += static_cast<double>(occupied) / static_cast<double>(kept);
  }

  void write(Table& table) const {
    const auto scans = static_cast<double>(scans_);
    table.set("occupied", occupied_ / scans);
    table.set("kept", kept_ / scans);
    table.set("compression_mean", sum_of_ratios_ / ratios_);
    table.set("compression_all", occupied_ / kept_);
  }

 private:
  size_t scans_ = 0;
  double occupied_ = 0.0;
  double kept_ = 0.0;
  double ratios_ = 0.0;  // of scans that have edges
  double sum_of_ratios_ = 0.0;
};

/// Sums over the scans of a recording, by one method at one voxel size.
struct ScanSums {
  Compression compression;
  Agreement with_scans;
  Agreement with_map;
  Recall recall;
  TruthScore truth;
  double seconds = 0.0;
};

void writeTruth(const TruthScore& truth, Table& table) {
  table.set("precision", truth.precision());
  table.set("precision_wide", truth.widePrecision());
  table.set("chance", truth.chance());
  table.set("coverage", truth.coverage());
  table.set("false_rim", truth.causeShare(FalseEdgeCause::kRimOfView));
  table.set("false_jump", truth.causeShare(FalseEdgeCause::kRangeJump));
  table.set("false_gap", truth.causeShare(FalseEdgeCause::kScanLineGap));
  table.set("false_other", truth.causeShare(FalseEdgeCause::kNothingGone));
}

void writeSums(const ScanSums& sums, size_t scans, Table& table) {
  sums.compression.write(table);
  table.set("again_edges", sums.with_scans.edgeShare());
  table.set("again_others", sums.with_scans.otherShare());
  table.set("above_chance", sums.with_scans.edgeShare() - sums.with_scans.otherShare());
  table.set("map_precision", sums.with_map.edgeShare());
  table.set("map_chance", sums.with_map.otherShare());
  table.set("map_recall", sums.recall.share());
  writeTruth(sums.truth, table);
  table.set("ms", 1e3 * sums.seconds / static_cast<double>(scans));
}

Table emptyTable() {
  return Table({{"voxel_m", "voxel [m]"},
                {"method", "edges of"},
                {"occupied", "occupied", 0},
                {"kept", "kept", 0},
                {"compression_mean", "compression, mean a scan"},
                {"compression_all", "of all"},
                {"again_edges", "edges found again", 3},
                {"again_others", "others found again", 3},
                {"above_chance", "above chance", 3},
                {"map_precision", "in the map too", 3},
                {"map_chance", "the same of others", 3},
                {"map_recall", "recall of the map's", 3},
                {"precision", "precision", 3},
                {"precision_wide", "within 3 voxels", 3},
                {"chance", "chance", 3},
                {"coverage", "coverage", 3},
                {"ghosts", "ghosts", 0},
                {"ghost_share", "share of the map", 4},
                {"false_rim", "rim of the view"},
                {"false_jump", "range jump"},
                {"false_gap", "gap between scan lines"},
                {"false_moved", "moved object"},
                {"false_other", "other"},
                {"ms", "CPU a scan [ms]"}});
}

/// Where movers were during these scans.
sim::World movedIn(const Recording& recording, size_t first, size_t last) {
  return sim::volumeOf(recording.truth->movers, recording.scans[first].view.stamp,
                       endOf(recording, last));
}

/// Null unless something moves.
std::unique_ptr<GhostJudge> ghostJudgeOf(const Recording& recording) {
  if (!recording.truth || recording.truth->movers.empty()) return nullptr;
  return std::make_unique<GhostJudge>(*recording.truth, recording.scans.front().view.stamp,
                                      endOf(recording, recording.scans.size() - 1));
}

/// All scans in one map, labelled.
struct LabelledMap {
  LabelledVoxels voxels;
  std::vector<Eigen::Vector3f> centroids;  // of its occupied voxels [m]
  double label_seconds = 0.0;              // of all labellings
};

LabelledMap buildMap(const Recording& recording, const Config& config, double voxel_size,
                     const Pose& T_map_grid) {
  Voxelizer voxelizer(config.voxelizer, voxel_size);
  MapConfig map_config = config.map;
  map_config.coarsest_voxel = kMapLevels * voxel_size;
  MapBuilder map(voxel_size, map_config, config.edges, 1);
  LabelledMap labelled;
  const Pose T_grid_map = T_map_grid.inverse();
  for (size_t i = 0; i < recording.scans.size(); ++i) {
    const RecordedScan& scan = recording.scans[i];
    auto centroids = placedCentroids(recording, i, voxelizer.voxelize(scan.view));
    for (Eigen::Vector3d& centroid : centroids) centroid = T_grid_map * centroid;
    map.add(centroids, T_grid_map * scan.T_map_sensor.translation());
    if (!map.labelDue() && i + 1 < recording.scans.size()) continue;
    StageTimer timer(Clock::kProcessCpu);
    map.label();
    labelled.label_seconds += timer.lap();
  }
  labelled.voxels = labelledVoxels(map, T_map_grid);
  labelled.centroids = centroidsOf(map, map.hitVoxels());
  return labelled;
}

/// A grid in which the faces of a world do not lie on the borders of voxels.
Pose turnedGrid(double voxel_size) {
  return Eigen::Translation3d(voxel_size * Eigen::Vector3d(0.37, 0.41, 0.43)) *
         Eigen::AngleAxisd(kGridYaw, Eigen::Vector3d::UnitZ());
}

/// All methods at one voxel size.
class SizeMeasurement {
 public:
  SizeMeasurement(const Recording& recording, const EdgeTruth* truth, double voxel_size,
                  const EdgeMeasureOptions& options)
      : recording_(recording),
        truth_(truth),
        voxel_size_(voxel_size),
        options_(options),
        voxelizer_(options.config.voxelizer, voxel_size),
        map_(buildMap(recording, options.config, voxel_size, Pose::Identity())),
        map_cells_(cellsOf(map_.voxels, Pose::Identity())),
        ghosts_(ghostJudgeOf(recording)) {
    if (truth != nullptr) judge_ = std::make_unique<EdgeJudge>(*truth, voxel_size);
  }

  void measure(Table& table, const std::function<void(const std::string&)>& note) {
    for (const Method& method : kMethods) {
      note("edges of a " + std::string(method.name));
      startRow(method.name, table);
      const ScanSums sums = measureScans(method);
      writeSums(sums, recording_.scans.size(), table);
      writeMoved(sums.truth, table);
    }
    if (options_.detectors) measureDetectors(table, note);
    note("edges of scans in a window");
    startRow("scan in a window", table);
    writeSums(measureWindows(), recording_.scans.size(), table);
    note("edges of the map");
    startRow("map", table);
    writeMap(map_, table);
    startRow("map in a turned grid", table);
    writeMap(buildMap(recording_, options_.config, voxel_size_, turnedGrid(voxel_size_)), table);
    note("octrees");
    measureOctrees(table);
  }

 private:
  void startRow(const std::string& method, Table& table) const {
    table.addRow();
    table.set("voxel_m", voxel_size_);
    table.set("method", method);
  }

  ScanSums measureScans(const Method& method) {
    EdgeExtractor extractor(configOf(method, options_.config.edges), 1);
    TruthScore caused;
    ScanSums sums = measureEach([&](size_t i, VoxelScan scan, double& seconds) {
      StageTimer timer(Clock::kProcessCpu);
      extractor.extract(scan);
      seconds += timer.lap();
      LabelledVoxels voxels = labelledVoxels(recording_, i, scan);
      caused += causesInScan(i, voxels);
      return voxels;
    });
    sums.truth += caused;
    return sums;
  }

  /// Each marks as many edges of a scan as the default. They are not written for speed: their time
  /// is left out.
  void measureDetectors(Table& table, const std::function<void(const std::string&)>& note) {
    EdgeExtractor extractor(options_.config.edges, 1);
    for (const EdgeDetector& detector : kEdgeDetectors) {
      note("edges by " + std::string(detector.name));
      startRow(detector.name, table);
      ScanSums sums = measureEach([&](size_t i, VoxelScan scan, double&) {
        const size_t count = extractor.extract(scan).edges;
        markStrongest(detector, count, scan);
        return labelledVoxels(recording_, i, scan);
      });
      sums.seconds = std::numeric_limits<double>::quiet_NaN();
      writeSums(sums, recording_.scans.size(), table);
    }
  }

  /// Measures in the turned grid, as no scan lies along the map's axes. Two windows that share
  /// scans agree by that: their repeatability is left out. The causes of false edges lie in several
  /// scans.
  ScanSums measureWindows() {
    const Config& config = options_.config;
    const Pose T_map_grid = turnedGrid(voxel_size_);
    RecentEdges recent(voxel_size_, config.edges, config.mapper.edge_window, 1);
    ScanSums sums = measureEach([&](size_t i, const VoxelScan& scan, double& seconds) {
      auto centroids = placedCentroids(recording_, i, scan);
      for (Eigen::Vector3d& centroid : centroids) centroid = T_map_grid.inverse() * centroid;
      StageTimer timer(Clock::kProcessCpu);
      recent.add(centroids);
      const BitGrid<16> edges = recent.edgeVoxels();
      seconds += timer.lap();
      return labelledVoxels(recent.occupied(), edges, voxel_size_, T_map_grid);
    });
    const auto window = static_cast<size_t>(config.mapper.edge_window);
    if (options_.pair_step < window) sums.with_scans = {};
    return sums;
  }

  /// `label(i, scan, seconds)` gives the voxels of a scan and adds the time it took.
  template <typename Label>
  ScanSums measureEach(const Label& label) {
    ScanSums sums;
    RingBuffer<LabelledVoxels> before(options_.pair_step);
    for (size_t i = 0; i < recording_.scans.size(); ++i) {
      LabelledVoxels voxels = label(i, voxelizer_.voxelize(recording_.scans[i].view), sums.seconds);
      addScan(i, voxels, sums);
      if (before.isFull()) {
        const Cells cells = cellsOf(voxels, voxels.T_map_grid);
        sums.with_scans += agreement(before.oldest(), cells, voxels.T_map_grid);
      }
      before.push(std::move(voxels));
    }
    return sums;
  }

  void addScan(size_t i, const LabelledVoxels& voxels, ScanSums& sums) const {
    sums.compression.add(voxels.occupied(), voxels.edges);
    sums.with_map += agreement(voxels, map_cells_, Pose::Identity());
    sums.recall += recallOf(voxels, map_cells_.edges);
    if (judge_ == nullptr) return;
    sums.truth += judge_->score(voxels, truth_->seen_by[i]);
  }

  TruthScore causesInScan(size_t i, const LabelledVoxels& voxels) const {
    TruthScore score;
    if (judge_ == nullptr) return score;
    const SimulatedTruth& simulated = *recording_.truth;
    const FalseEdgeJudge judge(simulated.world, simulated.sensor,
                               {recording_.scans[i].T_map_sensor}, movedIn(recording_, i, i));
    score.causes = judge_->causes(voxels, judge, kJudgedInScan, [&](const LabelledVoxel& edge) {
      return recording_.poseAt(i, edge.time_offset);
    });
    return score;
  }

  void writeMap(const LabelledMap& map, Table& table) const {
    Compression compression;
    compression.add(map.voxels.occupied(), map.voxels.edges);
    compression.write(table);
    table.set("ms", 1e3 * map.label_seconds / static_cast<double>(recording_.scans.size()));
    if (judge_ == nullptr) return;
    TruthScore score = judge_->score(map.voxels, truth_->seen);
    std::vector<Pose> poses;
    for (const RecordedScan& scan : recording_.scans) poses.push_back(scan.T_map_sensor);
    const SimulatedTruth& simulated = *recording_.truth;
    const FalseEdgeJudge judge(simulated.world, simulated.sensor, std::move(poses),
                               movedIn(recording_, 0, recording_.scans.size() - 1));
    score.causes = judge_->causes(map.voxels, judge, kJudgedInMap,
                                  [&](const LabelledVoxel&) { return map.voxels.T_map_grid; });
    writeTruth(score, table);
    writeMoved(score, table);
    writeGhosts(map, table);
  }

  void writeMoved(const TruthScore& truth, Table& table) const {
    if (ghosts_ == nullptr) return;
    table.set("false_moved", truth.causeShare(FalseEdgeCause::kMovedObject));
  }

  void writeGhosts(const LabelledMap& map, Table& table) const {
    if (ghosts_ == nullptr) return;
    const size_t ghosts = ghosts_->count(map.centroids, voxel_size_, map.voxels.T_map_grid);
    table.set("ghosts", static_cast<double>(ghosts));
    table.set("ghost_share", shareOf(ghosts, map.centroids.size()));
  }

  void measureOctrees(Table& table) {
    Compression leaves;
    Compression merged;
    for (const RecordedScan& scan : recording_.scans) {
      VoxelScan voxels = voxelizer_.voxelize(scan.view);
      const size_t occupied = EdgeExtractor(options_.config.edges, 1).extract(voxels).occupied;
      addOctree(pointsOf(scan.view, options_.config.voxelizer), occupied, leaves, merged);
    }
    Compression map_leaves;
    Compression map_merged;
    addOctree(map_.centroids, map_.voxels.occupied(), map_leaves, map_merged);
    writeOctree("octree of a scan", leaves, table);
    writeOctree("merged octree of a scan", merged, table);
    writeOctree("octree of the map", map_leaves, table);
    writeOctree("merged octree of the map", map_merged, table);
  }

  void addOctree(const std::vector<Eigen::Vector3f>& points, size_t occupied, Compression& leaves,
                 Compression& merged) const {
    std::vector<VoxelIndex> keys = octreeLeaves(points, voxel_size_);
    leaves.add(occupied, keys.size());
    merged.add(occupied, mergedLeafCount(std::move(keys)));
  }

  void writeOctree(const char* name, const Compression& compression, Table& table) const {
    startRow(name, table);
    compression.write(table);
  }

  const Recording& recording_;
  const EdgeTruth* truth_;  // null unless simulated
  double voxel_size_;
  const EdgeMeasureOptions& options_;
  Voxelizer voxelizer_;
  LabelledMap map_;
  Cells map_cells_;
  std::unique_ptr<GhostJudge> ghosts_;  // null unless simulated with movers
  std::unique_ptr<EdgeJudge> judge_;    // null unless simulated
};

}  // namespace

Table measureEdges(const Recording& recording, const EdgeMeasureOptions& options,
                   const std::function<void(const std::string&)>& note) {
  std::unique_ptr<EdgeTruth> truth;
  if (recording.truth) {
    note("true edges");
    truth = std::make_unique<EdgeTruth>(recording);
  }
  Table table = emptyTable();
  for (const double size : options.voxel_sizes) {
    note("map of " + std::to_string(std::lround(1e3 * size)) + " mm voxels");
    SizeMeasurement(recording, truth.get(), size, options).measure(table, note);
  }
  return table;
}

}  // namespace edgevox
