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

struct EdgeMeasureOptions {
  std::vector<double> voxel_sizes = {0.05, 0.1, 0.2, 0.4};  ///< of the map [m]
  size_t pair_step = 5;                                     ///< scans from the first of a pair on
  bool detectors = false;                                   ///< measure kEdgeDetectors, too
  Config config;                                            ///< but for voxel_size and edges.mode
  std::string config_name = "the defaults";                 ///< to print
};

/// The extractors by name: as published, the default without and with its support filter, the
/// accumulated map, and, for comparison, octrees and other detectors of edges. A row for each at
/// each voxel size.
/// `note` is told what is being measured. Throws ConfigError.
Table measureEdges(const Recording& recording, const EdgeMeasureOptions& options,
                   const std::function<void(const std::string&)>& note);

/// The table in parts, with what its columns mean.
std::string edgesMarkdown(const Recording& recording, const EdgeMeasureOptions& options,
                          const Table& table);

}  // namespace edgevox
