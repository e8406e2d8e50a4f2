// SPDX-License-Identifier: BSD-3-Clause
// The subcommands of the tool map. Each has its own options and its own file.
#pragma once

#include "tools/options.hpp"

namespace edgevox {

/// Runs the subcommand that the first argument names; gives the exit code. Throws UsageError and
/// what the subcommand throws.
int runMapTool(const Arguments& arguments);

/// The arguments are those that follow the subcommand's name. Each throws std::invalid_argument if
/// they are wrong or do not suit the map, FileError and MapFileError.
void mapInfo(const Arguments& arguments);
void mapConvert(const Arguments& arguments);
void mapDiff(const Arguments& arguments);
void mapMerge(const Arguments& arguments);
void mapDraw(const Arguments& arguments);

}  // namespace edgevox
