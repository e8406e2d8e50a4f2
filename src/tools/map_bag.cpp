// SPDX-License-Identifier: BSD-3-Clause
// Maps the clouds of a bag without a ROS master. Exit codes: 1 no results, 2 wrong usage, 3 results
// of a part of the bag, as the rest could not be read.
#include <unistd.h>

#include <exception>
#include <iostream>

#include "tools/map_bag_run.hpp"

int main(int argc, char** argv) {
  try {
    const auto options = edgevox::parseMapBagOptions(argc, argv);
    if (!options) return 0;
    edgevox::Console console(std::cerr, isatty(STDERR_FILENO) != 0);
    const edgevox::MapBagOutcome outcome = edgevox::runMapBag(*options, console);
    std::cout << outcome.summary.table();
    if (outcome.loss.empty()) return 0;
    std::cerr << "map_bag: " << outcome.loss << "\n";
    return 3;
  } catch (const edgevox::UsageError& error) {
    std::cerr << "map_bag: " << error.what() << "\n";
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "map_bag: " << error.what() << "\n";
    return 1;
  }
}
