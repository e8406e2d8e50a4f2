// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "edgevox/config.hpp"
#include "edgevox/io/map_file.hpp"
#include "edgevox/io/trajectory_evaluation.hpp"
#include "edgevox/map/map_builder.hpp"
#include "edgevox/mapping/mapper.hpp"
#include "run/report.hpp"
#include "run/run_record.hpp"

namespace edgevox {

/// A row a scan, a column a stage.
std::string timingsCsv(const Pool<ScanRecord>& scans);
/// A row for each pose that the reference knows.
std::string errorsCsv(const TrajectoryErrors& errors);

/// The errors in a few numbers.
Report errorsReport(const TrajectoryErrors& errors);

struct RunSize {
  size_t map_bytes = 0;      ///< of the map's compact file
  double peak_rss_mb = 0.0;  ///< of the process, before files were written
};

/// The run, and the map, if there is one, with its labels up to date, in a few numbers.
Report summarise(const RunRecord& run, const MapBuilder* map, const RunSize& size,
                 const std::optional<TrajectoryErrors>& errors = std::nullopt);

/// Makes the folder with all folders above it. Throws FileError.
void makeFolder(const std::filesystem::path& folder);

struct RunResults {
  const Config& config;
  const RunRecord& run;
  Mapper* mapper = nullptr;  ///< its labels are brought up to date; null where nothing was mapped
  std::string map_frame = "map";
  MapContent content = MapContent::kCompact;  ///< of map.edgevox
  bool occupied_too = false;                  ///< also write map_occupied.ply
  std::optional<TrajectoryErrors> errors = std::nullopt;
};

/// Makes the folder if need be and puts the files of the run, all together, in the place of those
/// of an earlier one. Gives the summary; throws FileError, also where there is neither a map nor a
/// pose.
Report writeRun(const std::filesystem::path& folder, const RunResults& results);

}  // namespace edgevox
