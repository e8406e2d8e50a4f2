// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "run/report.hpp"
#include "tools/console.hpp"
#include "tools/map_bag_options.hpp"

namespace edgevox {

/// Maps a bag and writes the results to options.output; gives the summary. Throws ConfigError,
/// BagError, FileError or TrajectoryError.
Report runMapBag(const MapBagOptions& options, Console& console);

}  // namespace edgevox
