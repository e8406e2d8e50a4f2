// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "edgevox/parameter.hpp"

namespace edgevox {

/// Which voxels of the map scans are aligned to.
enum class Representation {
  kSparse,  ///< planes, and of what lies in none edges and flat anchors
  kAll,     ///< planes and all occupied voxels
  kRandom,  ///< planes and as many voxels as kSparse has, by hash: the yardstick for kSparse
  kEdges,   ///< edge voxels of the accumulated map alone, as in Ryde et al. 2013
};

enum class EdgeMode {
  kDefault,  ///< Sobel gradients, corners kept, support filter
  kPaper,    ///< Ryde et al. 2013, eq. 5-7 with t_mag = 1 and t_ratio = 0; nothing else applies
};

enum class MatcherMode {
  kRefined,    ///< discrete search, then voxel-Gaussian refinement
  kPublished,  ///< Ryde and Hu 2010: hill climbing alone
};

enum class InstructionSet { kAuto, kPortable, kAvx2 };

enum class TimeUnit { kAuto, kSeconds, kMilliseconds, kMicroseconds, kNanoseconds, kNone };

/// Which point of a sweep its stamp is of.
enum class StampAt { kAuto, kFirst, kLast };

struct VoxelizerConfig {
  double min_range = 0.5;                ///< [m]
  double max_range = 120.0;              ///< [m]
  int max_points = 5000000;              ///< of a cloud that is read
  int max_voxels = 300000;               ///< of a scan
  TimeUnit time_unit = TimeUnit::kAuto;  ///< of the times of points in clouds
  StampAt stamp_at = StampAt::kAuto;
};

/// What is an edge in occupancy of a certain density.
struct EdgeThresholds {
  double ratio = 0.0;    ///< least middle / largest eigenvalue of the structure tensor
  double support = 0.0;  ///< least eigenvalue of the neighbours' covariance [voxel^2], 0: off
};

struct EdgeConfig {
  EdgeMode mode = EdgeMode::kDefault;
  double magnitude = 0.10;  ///< least middle eigenvalue, of a plane's largest
  EdgeThresholds scan{0.10, 0.35};
  EdgeThresholds map{0.15, 0.5};  ///< of accumulated occupancy, which is denser than a scan's
  int map_neighbours = 8;  ///< edges among its 26 neighbours that one of the map needs, 0: off
  InstructionSet instruction_set = InstructionSet::kAuto;
};

struct MapConfig {
  Representation representation = Representation::kSparse;
  int min_hits = 2;             ///< scans that must have hit a voxel for it to count as occupied
  double coarsest_voxel = 6.4;  ///< of the search, rounded to voxel_size * 2^k [m]
  int anchors = 8;      ///< flat voxels out of planes kept in a cube of 16, by three directions
  int label_every = 5;  ///< scans between two labellings
  int clear_after = 0;  ///< scans that see through a voxel unhit before it leaves, 0: off
  /// Scans within which a voxel that stands alone must be hit again to enter the map, 0: off
  int confirm_within = 10;
  /// Scans after which places out of reach of the sensor keep no more than what matching needs,
  /// 0: never
  int freeze_after = 50;
  int memory = 4000;  ///< of the map while mapping, after which no voxels are added [MB]
};

struct MatcherConfig {
  MatcherMode mode = MatcherMode::kRefined;
  int search_points = 1000;
  int refine_points = 3000;  ///< of those with a voxel of the map beside them
  int restart_points = 300;
  int max_restarts = 60;
  double min_hit_ratio = 0.5;        ///< of an accepted match, before there is a history
  double relative_hit_ratio = 0.65;  ///< of an accepted match, of the running median
};

/// Of a search without a prediction.
struct SearchConfig {
  int points = 300;
  double tilt = 0.0;           ///< of the sensor from what is known of it [deg]
  double min_evidence = 0.75;  ///< share of the points that fit, see evidenceOf()
  double margin = 0.03;        ///< of the evidence, by which the best pose must exceed others
};

struct LocalizerConfig {
  int search_after = 10;  ///< lost scans in a row, 0: never
};

/// Which voxels of a scan are matched and mapped.
enum class ScanVoxels {
  kAll,
  kEdges,  ///< as published: those that EdgeExtractor has marked
};

/// What to do with the map when the clock has jumped back.
enum class AfterClockJump { kKeepMap, kClearMap };

struct MapperConfig {
  ScanVoxels scan_voxels = ScanVoxels::kAll;
  double fallback_hit_ratio = 0.75;  ///< of its running median: match all voxels below it
  double fallback_sigma = 1.6;       ///< worst deviation of the pose / its running median
  int fallback_matches = 100;        ///< match all voxels below it
  double max_speed = 40.0;           ///< of the sensor [m/s]
  double max_turn = 180.0;           ///< the same [deg/s]
  double clock_jump = 2.0;           ///< a stamp so much before the last one is no late scan [s]
  double clock_leap = 3600.0;  ///< a stamp later by more must be confirmed by a second one [s]
  AfterClockJump after_clock_jump = AfterClockJump::kKeepMap;
  int edge_window = 10;  ///< scans by whose occupancy the edges of the last one are told
  int search_after = 0;  ///< lost scans in a row, until the whole map is searched; 0: never
};

struct Config {
  double voxel_size = 0.2;  ///< finest voxel of the map [m]
  int threads = 1;
  VoxelizerConfig voxelizer;
  EdgeConfig edges;
  MapConfig map;
  MatcherConfig matcher;
  SearchConfig search;
  MapperConfig mapper;
  LocalizerConfig localizer;
};

/// The parameters of the algorithms, valid as long as `config`.
std::vector<Parameter> parametersOf(Config& config);

/// Throws ConfigError that names the parameter, its value and its range.
void validate(const Config& config);

/// All parameters but `threads`, on which no result depends, in YAML, groups nested.
std::string yamlText(const Config& config);

}  // namespace edgevox
