// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/config.hpp"

#include <algorithm>

namespace edgevox {
namespace {

/// Words stand for the values 0, 1, 2, ... of the enumeration.
template <typename Enum>
Choice choiceOf(Enum& value, std::vector<std::string> words) {
  return {words, [&value, words] { return words[static_cast<size_t>(value)]; },
          [&value, words](const std::string& word) {
            const auto found = std::find(words.begin(), words.end(), word);
            if (found == words.end()) return false;
            value = static_cast<Enum>(found - words.begin());
            return true;
          }};
}

}  // namespace

std::vector<Parameter> parametersOf(Config& c) {
  constexpr int kMaxCount = 1000000;
  constexpr int kMaxLarge = 1000000000;
  return {
      {"voxel_size", &c.voxel_size, 0.01, 10, "m",
       "finest voxel of the map; scans are voxelized at half of it"},
      {"threads", &c.threads, 1, 64, "", "threads that label edges; results do not depend on it"},
      {"voxelizer/min_range", &c.voxelizer.min_range, 0, 1000, "m", "nearer points are dropped"},
      {"voxelizer/max_range", &c.voxelizer.max_range, 0.1, 10000, "m",
       "farther points are dropped"},
      {"voxelizer/max_points", &c.voxelizer.max_points, 1, kMaxLarge, "",
       "a cloud of more points is refused: bounds the memory"},
      {"voxelizer/max_voxels", &c.voxelizer.max_voxels, 50, kMaxLarge, "",
       "a scan of more voxels is refused: bounds the memory"},
      {"voxelizer/time_unit",
       choiceOf(c.voxelizer.time_unit, {"auto", "s", "ms", "us", "ns", "none"}), 0, 0, "",
       "of the points' times; 'auto' finds the one in which a sweep takes up to 2 s, 'none' "
       "ignores "
       "them"},
      {"voxelizer/stamp_at", choiceOf(c.voxelizer.stamp_at, {"auto", "first", "last"}), 0, 0, "",
       "point of a sweep whose time its stamp is; 'auto' takes the times as they are, or, if they "
       "are of another clock, 'first'"},
      {"edges/mode", choiceOf(c.edges.mode, {"default", "paper"}), 0, 0, "",
       "'paper' is the extractor exactly as published; no other parameter of edges applies to it"},
      {"edges/magnitude", &c.edges.magnitude, 0.001, 1, "",
       "least middle eigenvalue of the structure tensor, relative to a plane's largest"},
      {"edges/scan_ratio", &c.edges.scan.ratio, 0, 1, "",
       "least ratio of the middle to the largest eigenvalue in one scan", "edges/ratio"},
      {"edges/scan_support", &c.edges.scan.support, 0, 4, "voxel^2",
       "least spread of the occupied voxels around an edge of one scan; 0 is off"},
      {"edges/map_ratio", &c.edges.map.ratio, 0, 1, "",
       "as edges/scan_ratio, in the accumulated map"},
      {"edges/map_support", &c.edges.map.support, 0, 4, "voxel^2",
       "as edges/scan_support, in the accumulated map"},
      {"edges/map_neighbours", &c.edges.map_neighbours, 0, 26, "",
       "edges that an edge of the accumulated map needs around it, which keeps the middle of each "
       "band of them; 0 is off"},
      {"edges/instruction_set", choiceOf(c.edges.instruction_set, {"auto", "portable", "avx2"}), 0,
       0, "", "results do not depend on it"},
      {"map/representation", choiceOf(c.map.representation, {"sparse", "all", "random", "edges"}),
       0, 0, "",
       "what scans are aligned to: planes and the edges and planar anchors in none of them; planes "
       "and all voxels; planes and as many voxels by chance; or edge voxels alone"},
      {"map/min_hits", &c.map.min_hits, 1, 100, "", "scans that must hit a voxel before it counts"},
      {"map/coarsest_voxel", &c.map.coarsest_voxel, 0.1, 100, "m",
       "largest voxel of the search: how far from the prediction a pose is found",
       "matcher/coarsest_voxel"},
      {"map/anchors", &c.map.anchors, 0, 1000, "",
       "planar voxels in no plane, of each of three directions, that scans are aligned to in a "
       "cube of 16 voxels"},
      {"map/label_every", &c.map.label_every, 1, 100, "",
       "scans between two labellings of the map"},
      {"map/clear_after", &c.map.clear_after, 0, 1000, "",
       "scans that must see through an occupied voxel, without a hit in between, before it leaves "
       "the map; 0: none leaves"},
      {"map/confirm_within", &c.map.confirm_within, 0, 1000, "",
       "scans within which a point that stands alone must be hit again to enter the map; 0: all "
       "enter at once"},
      {"map/freeze_after", &c.map.freeze_after, 0, kMaxCount, "",
       "scans after which places farther than voxelizer/max_range that no scan has touched keep no "
       "more than what scans are aligned to, until the sensor comes back; 0: never"},
      {"map/memory", &c.map.memory, 1, kMaxCount, "MB",
       "of the map while mapping; when it is reached, the farthest places freeze as by "
       "map/freeze_after; if that does not help, known voxels are kept up to date and no new ones "
       "are added"},
      {"matcher/mode", choiceOf(c.matcher.mode, {"refined", "published"}), 0, 0, "",
       "'published' is hill climbing alone, for comparison"},
      {"matcher/search_points", &c.matcher.search_points, 50, kMaxCount, "",
       "points of a scan in the search"},
      {"matcher/refine_points", &c.matcher.refine_points, 50, kMaxCount, "",
       "points of a scan in the refinement, of those with a voxel of the map beside them"},
      {"matcher/restart_points", &c.matcher.restart_points, 50, kMaxCount, "",
       "points of a scan in a restart"},
      {"matcher/max_restarts", &c.matcher.max_restarts, 0, 10000, "",
       "searches from other poses around the prediction before a scan is lost, or to see that no "
       "other place fits as well"},
      {"matcher/min_hit_ratio", &c.matcher.min_hit_ratio, 0, 1, "",
       "share of a scan that must land in occupied voxels, before there is a history"},
      {"matcher/relative_hit_ratio", &c.matcher.relative_hit_ratio, 0, 1, "",
       "the same, of the running median"},
      {"search/points", &c.search.points, 50, kMaxCount, "",
       "points of a scan in a search of the whole map"},
      {"search/tilt", &c.search.tilt, 0, 180, "deg",
       "by which the sensor may be tilted against the odometry or its mounting; a search takes "
       "longer with its square"},
      {"search/min_evidence", &c.search.min_evidence, 0.1, 1, "",
       "least share of a scan that fits where a search has found it, less half of that of the "
       "lines of sight that would pass through walls"},
      {"search/margin", &c.search.margin, 0, 1, "",
       "of the evidence, by which the best pose must exceed all others; else the search is "
       "ambiguous"},
      {"mapper/scan_voxels", choiceOf(c.mapper.scan_voxels, {"all", "edges"}), 0, 0, "",
       "which voxels of a scan are matched and mapped; 'edges' is the system as published, see the "
       "preset paper"},
      {"mapper/fallback_hit_ratio", &c.mapper.fallback_hit_ratio, 0, 1, "",
       "of the running median; below it a scan is aligned to all voxels"},
      {"mapper/fallback_sigma", &c.mapper.fallback_sigma, 1, 1000, "",
       "of the running median; a pose less certain is aligned to all voxels"},
      {"mapper/fallback_matches", &c.mapper.fallback_matches, 0, kMaxCount, "",
       "with fewer matched points a scan is aligned to all voxels"},
      {"mapper/max_speed", &c.mapper.max_speed, 0.1, 1000, "m/s",
       "of the sensor: how far from the first scan the second is accepted, and the longest step of "
       "an odometry that is believed"},
      {"mapper/max_turn", &c.mapper.max_turn, 1, 3600, "deg/s",
       "of the sensor: how far from its prediction a scan is accepted, and the largest turn of an "
       "odometry that is believed"},
      {"mapper/clock_jump", &c.mapper.clock_jump, 0, 1e6, "s",
       "a scan older than the last one by more means that the clock has jumped back; by less it is "
       "late and dropped"},
      {"mapper/clock_leap", &c.mapper.clock_leap, 1, 1e9, "s",
       "a scan later than the last one by more is dropped, unless one right before it was as late: "
       "its stamp may be wrong"},
      {"mapper/after_clock_jump", choiceOf(c.mapper.after_clock_jump, {"keep_map", "clear_map"}), 0,
       0, "",
       "what to do with the map when the clock has jumped back; the velocity is forgotten anyway"},
      {"mapper/edge_window", &c.mapper.edge_window, 1, 100, "",
       "scans, the last one among them, by which the edges of the last one are told on "
       "`scan_edges`"},
      {"mapper/search_after", &c.mapper.search_after, 0, kMaxCount, "",
       "lost scans in a row, after which the sensor is looked for in the whole map; 0: never"},
      {"localizer/search_after", &c.localizer.search_after, 0, kMaxCount, "",
       "the same, of a sensor that is localized in a saved map"},
  };
}

void validate(const Config& config) {
  Config copy = config;
  for (const Parameter& parameter : parametersOf(copy)) checkRange(parameter);
  if (config.voxelizer.min_range >= config.voxelizer.max_range) {
    throw ConfigError("parameter 'voxelizer/min_range' must be less than 'voxelizer/max_range'");
  }
}

std::string yamlText(const Config& config) {
  Config copy = config;
  std::string text;
  std::string group;
  for (const Parameter& parameter : parametersOf(copy)) {
    if (parameter.name == "threads") continue;  // no result depends on it
    const size_t slash = parameter.name.find('/');
    const bool grouped = slash != std::string::npos;
    const std::string its_group = grouped ? parameter.name.substr(0, slash) : "";
    if (grouped && its_group != group) text += its_group + ":\n";
    group = its_group;
    text += (grouped ? "  " : "") + parameter.name.substr(grouped ? slash + 1 : 0) + ": " +
            valueText(parameter) + "\n";
  }
  return text;
}

}  // namespace edgevox
