// SPDX-License-Identifier: BSD-3-Clause
// Maps the clouds of a bag without a ROS master. Exit codes: 1 no results, 2 wrong usage or
// configuration, 3 results that lack something, as a part of the bag or the reference could not be
// used, 4 results of less than half of the clouds, as the others were not located.
#include <unistd.h>

#include <iostream>

#include "tools/map_bag_run.hpp"
#include "tools/options.hpp"

namespace {

int mapBag(const edgevox::Arguments& arguments) {
  const auto options = edgevox::parseMapBagOptions(arguments);
  if (!options) return 0;
  edgevox::Console console(std::cerr, isatty(STDERR_FILENO) != 0);
  const edgevox::MapBagOutcome outcome = edgevox::runMapBag(*options, console);
  std::cout << outcome.summary.table();
  for (const std::string& text : {outcome.warning, outcome.loss}) {
    if (!text.empty()) std::cerr << "map_bag: " << text << "\n";
  }
  if (!outcome.loss.empty()) return 3;
  return outcome.warning.empty() ? 0 : 4;
}

}  // namespace

int main(int argc, char** argv) { return edgevox::runTool("map_bag", argc, argv, mapBag); }
