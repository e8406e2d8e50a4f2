// SPDX-License-Identifier: BSD-3-Clause
// How often a single scan is found in a map without a guess.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "edgevox/config.hpp"
#include "edgevox/map/match_map.hpp"
#include "edgevox/matching/global_search.hpp"
#include "evaluation/recording.hpp"
#include "evaluation/table.hpp"

namespace edgevox {

struct SearchMeasureOptions {
  Config config;
  std::string config_name = "the defaults";  ///< to print
  std::string map_name;                      ///< the same
  Pose T_map_recording = Pose::Identity();   ///< from the frame of the recording's poses
  bool level = false;    ///< the sensor is taken as level; else it is told where up is
  size_t pcl_every = 0;  ///< of the scans so many are looked for by PCL, too; 0: none
};

enum class SearchVerdict {
  kRight,      ///< found, within kFoundDistance and kFoundAngle of the truth
  kAmbiguous,  ///< several poses fit alike
  kNotFound,
  kWrong,  ///< found, but elsewhere
};
constexpr size_t kSearchVerdicts = 4;
const char* toString(SearchVerdict verdict);

/// One scan that was looked for.
struct SearchTrial {
  double stamp = 0.0;                    ///< [s]
  Pose T_map_sensor = Pose::Identity();  ///< the truth
  SearchVerdict verdict = SearchVerdict::kNotFound;
  bool among = false;      ///< the truth is one of the answers
  double distance = 0.0;   ///< of the best answer from the truth [m]; NaN: there is none
  double angle = 0.0;      ///< the same [degrees]
  double evidence = 0.0;   ///< for the best answer; NaN: there is none
  double runner_up = 0.0;  ///< for the next
  double hit_share = 0.0;  ///< of the best answer
  double seconds = 0.0;    ///< wall time
};

/// The trials of one method.
struct SearchTrials {
  std::string method;
  std::vector<SearchTrial> trials;
};

/// Looks for each scan of the recording, as seen at once, in a map, on all processors; for some of
/// them, if asked for, also by PCL, on one, which always gives a pose. edgevox comes first.
std::vector<SearchTrials> measureSearch(const MatchMap& map, const Recording& recording,
                                        const SearchMeasureOptions& options);

/// A row a trial.
Table searchTable(const std::vector<SearchTrials>& methods);

/// The counts and quantiles of all trials, with what they mean.
std::string searchMarkdown(const Recording& recording, const SearchMeasureOptions& options,
                           const std::vector<SearchTrials>& methods);

}  // namespace edgevox
