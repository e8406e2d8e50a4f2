// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "run/report.hpp"
#include "tools/console.hpp"
#include "tools/map_bag_options.hpp"

namespace edgevox {

struct MapBagOutcome {
  Report summary;
  std::string loss;  ///< what of the bag could not be read, in words; empty: nothing
};

/// Maps what can be read of a bag and writes the results to options.output. Throws ConfigError,
/// BagError, FileError or TrajectoryError; then the results of an earlier run stay.
MapBagOutcome runMapBag(const MapBagOptions& options, Console& console);

}  // namespace edgevox
