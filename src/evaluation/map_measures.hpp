// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "edgevox/config.hpp"
#include "evaluation/recording.hpp"
#include "evaluation/table.hpp"

namespace edgevox {

struct MapMeasureOptions {
  std::vector<int> anchors = {2, 4, 8, 16, 32};  ///< map/anchors: the points of the curve
  size_t capture_scans = 20;                     ///< from which a pose is to be found again ...
  size_t capture_trials = 10;                    ///< ... each from so many wrong guesses
  double capture_distance = 1.0;                 ///< of a guess from the pose [m]
  double capture_angle = 20.0;                   ///< the same [degrees]
  Config config;                                 ///< but for map.representation and map.anchors
  std::string config_name = "the defaults";      ///< to print
};

/// Maps the recording once for each size and representation of the map: error against the
/// recording's poses, and capture on the finished map, beside its bytes. Rows: all voxels, then for
/// each size the sparse map and as many by chance. `note` is told what is being measured.
Table measureMaps(const Recording& recording, const MapMeasureOptions& options,
                  const std::function<void(const std::string&)>& note);

/// The table, with what its columns mean.
std::string mapMarkdown(const Recording& recording, const MapMeasureOptions& options,
                        const Table& table);

}  // namespace edgevox
