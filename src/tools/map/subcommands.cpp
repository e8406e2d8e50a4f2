// SPDX-License-Identifier: BSD-3-Clause
#include "tools/map/subcommands.hpp"

#include "tools/dispatch.hpp"

namespace edgevox {

int runMapTool(const Arguments& arguments) {
  return dispatch(
      "map", "subcommand",
      {{"info", mapInfo, "what a map holds"},
       {"convert", mapConvert, "to a compact map, PLY, PCD, OctoMap or a map of map_server"},
       {"diff", mapDiff, "what one map has and another has not"},
       {"merge", mapMerge, "two maps of one frame in one"},
       {"draw", mapDraw, "a picture from above"}},
      arguments);
}

}  // namespace edgevox
