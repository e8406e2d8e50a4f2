// SPDX-License-Identifier: BSD-3-Clause
// Maps the clouds of a bag without a ROS master. Exit codes: 1 no results, 2 wrong usage or
// configuration, 3 results of a part of the bag, as the rest could not be read.
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
  if (outcome.loss.empty()) return 0;
  std::cerr << "map_bag: " << outcome.loss << "\n";
  return 3;
}

}  // namespace

int main(int argc, char** argv) { return edgevox::runTool("map_bag", argc, argv, mapBag); }
