// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "run/report.hpp"
#include "tools/console.hpp"
#include "tools/map_bag_options.hpp"

namespace edgevox {

struct MapBagOutcome {
  Report summary;
  std::string loss;     ///< what the results lack of what was asked for, in words; empty: nothing
  std::string warning;  ///< that most of the clouds were not mapped, and why; empty: they were
};

/// Maps what can be read of a bag and writes the results to options.output. Throws ConfigError,
/// BagError, FileError, or TrajectoryError if the reference cannot be read; then the results of an
/// earlier run stay.
MapBagOutcome runMapBag(const MapBagOptions& options, Console& console);

}  // namespace edgevox
