// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "edgevox/config.hpp"
#include "edgevox/mapping/mapper.hpp"
#include "run/run_record.hpp"

namespace edgevox {

/// Labels the map to its end and writes the files that map_bag writes. `folder` must be absolute
/// and is made if need be. `full`: a map file to go on with. Gives a line that says what was
/// written; throws FileError.
std::string saveRun(const std::string& folder, const Config& config, const RunRecord& run,
                    const std::string& map_frame, bool full, Mapper& mapper);

}  // namespace edgevox
