// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <filesystem>
#include <optional>
#include <string>

#include "edgevox/occupied_voxel_map.hpp"
#include "edgevox/trajectory_evaluation.hpp"
#include "run/report.hpp"
#include "run/run_record.hpp"

namespace edgevox {

/// A row a scan, a column a stage.
std::string timingsCsv(const std::deque<ScanRecord>& scans);
/// A row for each pose that the reference knows.
std::string errorsCsv(const TrajectoryErrors& errors);

/// The same in a few numbers.
Report errorsReport(const TrajectoryErrors& errors);

Report summarise(const RunRecord& run, const OccupiedVoxelMap& map,
                 const std::optional<TrajectoryErrors>& errors = std::nullopt);

/// With all folders above it. Throws FileError.
void makeFolder(const std::filesystem::path& folder);

/// map_edges.ply and .pcd, and map_occupied.ply if asked for. Throws FileError.
void writeMap(const std::filesystem::path& folder, const OccupiedVoxelMap& map,
              bool occupied_too = false);

}  // namespace edgevox
