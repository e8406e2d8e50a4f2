// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "edgevox/trajectory_evaluation.hpp"
#include "tools/cloud_mapping.hpp"
#include "tools/report.hpp"

namespace edgevox {

/// A row a scan, a column a stage.
std::string timingsCsv(const std::vector<ScanRecord>& scans);
/// A row for each pose that the reference knows.
std::string errorsCsv(const TrajectoryErrors& errors);

Report summarise(const CloudMapping& mapping, const std::optional<TrajectoryErrors>& errors);

}  // namespace edgevox
